// Nacre: parameters of the serial and the red-black solver, and the state that they keep between iterations.
#pragma once

#include <cmath>
#include <utility>

#include "compute/device/executor.hpp"
#include "compute/particles/particle_set.hpp"

namespace nacre {

/// Sec. 3.1.2.2. Damping is the lambda of Levenberg and Marquardt: per particle, for the whole run.
struct SolverParameters {
  PopulationRule population;
  float step = 0.5f;           ///< longest step of a particle, in h; the thesis allows 1
  float reach = 0.5f;          ///< a trial position must be this close to its junction, in h
  float first_damping = 0.1f;  ///< of a new particle
  float least_damping = 1e-4f;
  float most_damping = 1000;  ///< a particle that finds no lower energy below it stays where it is
  float damping_factor = 10;  ///< times on failure, through on success
  float still = 1e-3f;        ///< steps shorter than this, in h, are not worth a trial
};

/// What belongs to the particles of one ParticleSet beside it. `spare` is the other half of the double buffer that
/// particles are added and deleted through; the two swap arrays.
struct SolverState {
  ParticleSet spare;
  Array<float> damping, spare_damping;  ///< per particle
  std::uint32_t step = 0;               ///< how often the population was controlled
};

/// Particles with room for `capacity`, in permanent memory.
template <class Backend>
ParticleSet make_particle_set(Executor<Backend>& exec, std::int64_t capacity) {
  return allocate_particle_set(exec.arena(), capacity);
}

namespace detail {

/// Two unit vectors that are at right angles to each other and to the unit vector n (Duff et al. 2017).
NACRE_HD_INLINE void tangent_plane(const Vec3f& n, Vec3f& s, Vec3f& t) {
  const float sign = n.z < 0 ? -1.0f : 1.0f;
  const float a = -1 / (sign + n.z), b = n.x * n.y * a;
  s = Vec3f(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
  t = Vec3f(b, sign + n.y * n.y * a, -n.y);
}

struct SetDamping {
  float value;
  float* damping;
  NACRE_HD void operator()(std::int64_t i) const { damping[i] = value; }
};

struct MovingEnergy {
  const Float4* direction;
  NACRE_HD std::int64_t operator()(std::int64_t i) const { return std::int64_t(direction[i].w * 1048576.0f + 0.5f); }
};

/// The sizing field may have changed since the particles were put there.
template <class Surface>
struct ReadSize {
  Surface surface;
  Float4* position;
  NACRE_HD void operator()(std::int64_t i) const {
    position[i].w = surface.size({position[i].x, position[i].y, position[i].z});
  }
};

}  // namespace detail

/// As if the particles had no history.
template <class Backend>
void forget(Executor<Backend>& exec, SolverState& state, const SolverParameters& parameters) {
  state.step = 0;
  exec.for_each(state.damping.size(), detail::SetDamping{parameters.first_damping, state.damping.data()});
}

/// The arrays of a state for up to `capacity` particles, in permanent memory: an Arena, or an AllocationPlan.
template <class Memory>
SolverState allocate_solver_state(Memory& memory, std::int64_t capacity) {
  SolverState state;
  state.spare = allocate_particle_set(memory, capacity);
  state.damping = memory.template permanent<float>(capacity);
  state.spare_damping = memory.template permanent<float>(capacity);
  return state;
}

/// State for a set that has no history; `set.capacity()` bounds the number of particles from now on.
template <class Backend>
SolverState make_solver_state(Executor<Backend>& exec, const ParticleSet& set,
                              const SolverParameters& parameters = {}) {
  SolverState state = allocate_solver_state(exec.arena(), set.capacity());
  forget(exec, state, parameters);
  return state;
}

/// Mean energy of the moving particles as the last iteration left it; exact sums, so the same on any number of threads.
template <class Backend>
double mean_energy(Executor<Backend>& exec, const ParticleSet& set) {
  const std::int64_t moving = set.count - set.fixed;
  if (moving <= 0) return 0;
  const std::int64_t sum =
      exec.reduce(moving, std::int64_t(0), detail::MovingEnergy{set.direction.data() + set.fixed}, Add{});
  return double(sum) / 1048576 / double(moving);
}

}  // namespace nacre
