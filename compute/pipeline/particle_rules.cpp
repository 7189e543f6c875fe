// Nacre: how the knobs become parameters of the solvers: steps, population control, capacity.
#include "compute/pipeline/particle_rules.hpp"

#include <algorithm>

#include "compute/device/allocation_plan.hpp"
#include "compute/particles/ring_smoothing.hpp"
#include "compute/particles/solver_state.hpp"
#include "compute/pipeline/mesh_choices.hpp"

namespace nacre {

TreeRule tree_rule(const MeshParameters& parameters) {
  return {float(parameters.theta), float(parameters.step), float(parameters.momentum), 0.3f};
}

PopulationRule population_rule(const MeshParameters& parameters, int order) {
  PopulationRule rule;
  const double hexagonal = parameters.ideal_energy > 0 ? parameters.ideal_energy : hexagonal_energy;
  rule.ideal_energy = float(order == 2 ? hexagonal : hexagonal * row_energy / hexagonal_energy);
  rule.add_below = float(order == 2 ? parameters.add_below : std::max(parameters.add_below, 0.75));
  rule.delete_above = float(order == 2 ? parameters.delete_above : std::max(parameters.delete_above, 3.5));
  rule.certain_above = order == 2 ? 4.0f : 8.0f;
  rule.by_density = parameters.by_density;
  rule.may_add = parameters.particles == 0;
  rule.seed = parameters.seed;
  return rule;
}

double particle_capacity(double expected) { return 1.6 * expected + 20000; }

double solver_bytes(std::int64_t capacity, std::int64_t interfaces, const MeshParameters& parameters) {
  AllocationPlan solver, control, smoothing;
  TreeSolver planned(solver, capacity, interfaces, 1);
  if (solver_from_string(parameters.solver) != Solver::tree) allocate_solver_state(solver, capacity);
  // Of the temporaries, which come one after the other, these are the largest.
  detail::PopulationScratch(control, capacity);
  detail::SmoothingScratch(smoothing, capacity, 6 * capacity);
  return double(solver.bytes()) + double(std::max(control.bytes(), smoothing.bytes()));
}

std::int64_t require_room_for(double expected, std::int64_t interfaces, std::size_t free, const Device& device,
                              const MeshParameters& parameters, const std::string& why) {
  const double capacity = particle_capacity(expected);
  const bool countable = capacity <= 4e9;
  const double bytes = countable ? solver_bytes(std::int64_t(capacity), interfaces, parameters)
                                 : capacity / 1e6 * solver_bytes(1000000, interfaces, parameters);
  if (!countable || bytes > double(free))
    throw Error("too many particles for the memory",
                why + std::to_string(std::int64_t(expected)) + ", which take " +
                    std::to_string(std::int64_t(bytes / (1 << 20))) + " MiB; " + std::to_string(free >> 20) +
                    " MiB are free",
                device.too_small(parameters.particles > 0 ? "lower `particles`"
                                 : parameters.max_deviation > 0
                                     ? "raise `max_deviation`, `max_size` and `min_size`, or `epsilon`"
                                     : "raise `max_size` and `min_size`, or `epsilon`"));
  return std::int64_t(capacity);
}

}  // namespace nacre
