// Nacre: particles on surfaces with a formula, relaxed by either solver, and what is asked of the result.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "compute/particles/control.hpp"
#include "compute/particles/redblack.hpp"
#include "compute/particles/serial.hpp"
#include "tests/compute/particles/analytic_surfaces.hpp"

namespace nacre::test {

/// How many particles a surface of this area asks for at size h: a hexagonal lattice with spacing h.
inline double ideal_count(double area, double h = 1) { return area / (0.8660254 * h * h); }

enum class PlainSolver { serial, redblack };

/// A set of particles with all that a solver needs.
template <class Backend, class Surface>
struct Relaxation {
  Executor<Backend>& exec;
  Surface surface;
  PlainSolver solver;
  SolverParameters parameters;
  ParticleSet set;
  Array<Junction> table;
  SolverState state;
  std::vector<double> energy;

  Relaxation(Executor<Backend>& e, const Surface& s, PlainSolver by, const Seeds& seeds,
             const std::vector<Junction>& junctions, std::int64_t capacity = 0, const SolverParameters& with = {})
      : exec(e), surface(s), solver(by), parameters(with) {
    set = make_particles(exec, surface, seeds, capacity > 0 ? capacity : std::int64_t(4 * seeds.points.size()) + 1000);
    table = exec.arena().template permanent_copy<Junction>(junctions);
    state = make_solver_state(exec, set, parameters);
  }

  /// `count` iterations, the population controlled after every `every`-th (0: never).
  void iterate(int count, int every = 0) {
    for (int k = 1; k <= count; ++k) {
      const IterationResult r = solver == PlainSolver::serial
                                    ? serial_iteration(exec, set, state, table, surface, parameters)
                                    : redblack_iteration(exec, set, state, table, surface, parameters);
      energy.push_back(r.energy);
      if (every > 0 && k % every == 0) control();
    }
  }
  IterationResult control() { return control_population(exec, set, state, table, surface, parameters); }

  std::vector<Float4> positions() const { return set.position.download(0, std::size_t(set.count)); }
  std::vector<Float4> directions() const { return set.direction.download(0, std::size_t(set.count)); }
};

inline Vec3f xyz_of(const Float4& a) { return {a.x, a.y, a.z}; }

/// Distance of each point from the nearest other one, over the smaller h of the two; `from` skips the first ones.
inline std::vector<double> spacings(const std::vector<Float4>& position, std::size_t from = 0) {
  std::vector<double> result;
  for (std::size_t i = from; i < position.size(); ++i) {
    float nearest = 1e30f;
    for (std::size_t j = 0; j < position.size(); ++j) {
      const Vec3f r = xyz_of(position[i]) - xyz_of(position[j]);
      if (j != i) nearest = std::min(nearest, std::sqrt(dot(r, r)) / std::min(position[i].w, position[j].w));
    }
    result.push_back(nearest);
  }
  return result;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

/// Random seeds on a sphere of radius 10, as many as it wants: h is 1.
inline Seeds sphere_seeds(double share, float radius = 10, std::uint32_t seed = 7) {
  const int n = int(share * ideal_count(4 * M_PI * radius * radius));
  return {scattered_on_sphere(radius, n, seed), std::vector<std::uint32_t>(std::size_t(n), 0), 0};
}

}  // namespace nacre::test
