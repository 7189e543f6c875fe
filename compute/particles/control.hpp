// Nacre: population control: energies and gaps by the same teams over the same neighbourhoods that the red-black solver
// moves particles with (sec. 3.3.3).
#pragma once

#include "compute/particles/levenberg_marquardt.hpp"
#include "compute/particles/neighbourhoods.hpp"
#include "compute/particles/population.hpp"

namespace nacre {

namespace detail {

/// How far from a particle its second one goes, in h.
inline constexpr float gap_distance = 0.8f;

/// The emptiest position at some distance from a particle: where the energy is the lowest, of eight around it on a
/// surface, of the two beside it on a curve.
template <class Group, class Near>
NACRE_HD inline Vec3f find_gap(Group& group, const Near& near, const Mover& at, int order, float turn) {
  Vec3f s = at.direction, t;
  if (order == 2) tangent_plane(at.direction, s, t);
  Vec3f best = at.p;
  float least = 0;
  for (int k = 0; k < (order == 2 ? 8 : 2); ++k) {
    const float angle = order == 2 ? (float(k) + turn) * (pi / 4) : float(k) * pi;
    Mover trial = at;
    trial.p += (s * std::cos(angle) + t * std::sin(angle)) * (gap_distance * at.h);
    const float energy = near.energy(group, trial);
    if (k == 0 || energy < least) least = energy, best = trial.p;
  }
  return best;
}

template <class Surface>
struct PlanBin {
  Surface surface;
  PopulationRule rule;
  PopulationDemand demand;
  const Junction* table;
  std::uint32_t step;
  Float4* direction;
  PopulationPlan plan;

  std::size_t scratch_bytes() const { return NearInNeighbourhood::bytes; }

  NACRE_HD void operator()(Team& team, const Neighbourhood& around) const {
    for (int k = 0; k < around.own; ++k)
      if ((around.rows.tag[k] & Relation::fixed) == 0) decide(team, around, k);
  }

 private:
  NACRE_HD void decide(Team& team, const Neighbourhood& around, int k) const {
    const NeighbourhoodMemory& r = around.rows;
    const Mover at{{r.x[k], r.y[k], r.z[k]}, r.h[k], {r.nx[k], r.ny[k], r.nz[k]}};
    const std::uint32_t interface = r.tag[k], i = r.particle[k];
    const int order = table[interface].order();
    const NearInNeighbourhood near(team, team.scratch(), around, {table, interface}, k, at, gap_distance);
    const PairSums e = near.sums(team, at);
    Fate fate = population_fate(rule, demand, order, e.energy, e.neighbours, uniform_random(rule.seed, i, step));
    Vec3f gap = at.p;
    if (fate == Fate::split) gap = find_gap(team, near, at, order, uniform_random(rule.seed + 1, i, step));
    team.wait();
    if (!team.first()) return;
    const Float4 position{at.p.x, at.p.y, at.p.z, at.h};
    direction[i].w = e.energy;
    plan_particle(plan, fate, surface, table, i, interface, position, direction[i], gap);
  }
};

}  // namespace detail

/// Deletes crowded particles and splits lonely ones; `energy` of the result is the mean before that. Moving particles
/// change their indices in the arrays (they are written bin by bin, which the next iteration profits from); fixed ones
/// keep theirs. `carried` is what else particles have, `fresh` what new ones have of it; `step` counts the controls.
/// Works for any solver that leaves energies in direction.w. Throws Error where the set's capacity does not suffice.
template <class Backend, class Surface, class T>
IterationResult control_population(Executor<Backend>& exec, ParticleSet& set, ParticleSet& spare, Array<T>& carried,
                                   Array<T>& spare_carried, T fresh, const Array<Junction>& table,
                                   const Surface& surface, const PopulationRule& rule, std::uint32_t step) {
  if (set.count <= set.fixed) return {};
  Arena::Scope scope(exec.arena());
  const PopulationPlan plan = make_population_plan(exec, set.count);
  const PopulationDemand demand = population_demand(exec, set, rule, table);
  Neighbourhoods<Backend> neighbourhoods(exec, set, 0.5f * detail::gap_distance);
  neighbourhoods.for_each(
      detail::PlanBin<Surface>{surface, rule, demand, table.data(), step, set.direction.data(), plan});
  const double energy = mean_energy(exec, set);
  IterationResult result = apply_population(exec, set, spare, plan, neighbourhoods.bins().order.data(), table, surface,
                                            carried, spare_carried, fresh);
  result.energy = energy;
  return result;
}

/// The same for the serial and the red-black solver.
template <class Backend, class Surface>
IterationResult control_population(Executor<Backend>& exec, ParticleSet& set, SolverState& state,
                                   const Array<Junction>& table, const Surface& surface,
                                   const SolverParameters& parameters) {
  return control_population(exec, set, state.spare, state.damping, state.spare_damping, parameters.first_damping, table,
                            surface, parameters.population, state.step++);
}

}  // namespace nacre
