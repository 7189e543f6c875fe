// Nacre: how the serial and the red-black solver move one particle (sec. 3.1.2, Alg. 3.1).
#pragma once

#include "compute/field/inside_outside.hpp"
#include "compute/particles/near_list.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre {

/// A Surface defines where particles may be and how dense they are to be:
///
///   bool project(std::uint32_t interface, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const
///       the point of the interface near p, the unit normal (surface) or tangent (curve) there; false: not within reach
///   float size(const Vec3f& p) const    the sizing field h, voxels
///   bool project_with_team(Team&, unsigned char* scratch, ...as project) const, team_scratch_bytes
///       optional: all lanes of a team work on it, with that much scratch; used by the red-black solver
template <class Surface>
inline constexpr bool projects_with_team = requires {
  Surface::team_scratch_bytes;
};

template <class Surface>
constexpr std::size_t projection_scratch() {
  if constexpr (projects_with_team<Surface>)
    return Surface::team_scratch_bytes;
  else
    return 0;
}

/// Projects through the team where the surface can, in every lane alike where it cannot.
template <class Group, class Surface>
NACRE_HD_INLINE bool project_onto(Group& group, unsigned char* scratch, const Surface& surface, std::uint32_t interface,
                                  const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) {
  if constexpr (projects_with_team<Surface>)
    return surface.project_with_team(group, scratch, interface, p, reach, on, direction);
  else
    return surface.project(interface, p, reach, on, direction);
}

namespace detail {

NACRE_HD_INLINE Vec3f curvature_times(const PairSums& e, const Vec3f& v) {
  return {e.xx * v.x + e.xy * v.y + e.zx * v.z, e.xy * v.x + e.yy * v.y + e.yz * v.z,
          e.zx * v.x + e.yz * v.y + e.zz * v.z};
}

/// v = -(H + damping * stiffness * I)^-1 grad within the tangent plane (order 2) or along the tangent (order 1), Eq.
/// 3.3. The diagonal is raised by a multiple of one scale, not of itself: the Hessian of particles that push each other
/// is often indefinite, and then a scaled diagonal never becomes positive. False where it is not positive definite yet.
NACRE_HD inline bool damped_step(const PairSums& e, const Vec3f& direction, int order, float damping, Vec3f& v) {
  const float raise = damping * e.stiffness, least = 1e-3f * e.stiffness;
  if (order == 1) {
    const float a = dot(direction, curvature_times(e, direction)) + raise;
    if (!(a > least)) return false;
    v = direction * (-dot(e.gradient, direction) / a);
    return true;
  }
  Vec3f s, t;
  tangent_plane(direction, s, t);
  const Vec3f hs = curvature_times(e, s), ht = curvature_times(e, t);
  const float a = dot(s, hs) + raise, b = dot(s, ht), c = dot(t, ht) + raise, determinant = a * c - b * b;
  if (!(a > least && c > least && determinant > least * least)) return false;
  const float gs = dot(s, e.gradient), gt = dot(t, e.gradient);
  v = s * ((b * gt - c * gs) / determinant) + t * ((b * gs - a * gt) / determinant);
  return true;
}

}  // namespace detail

/// A particle before and after its turn.
struct RelaxedParticle {
  Mover at;
  float energy = 0, damping = 0;
  bool moved = false;
};

/// One turn of a particle: E, gradient and Hessian once, then steps that shrink as the damping grows, until one of them
/// gives a lower energy; the step is computed again for each damping, the energy among the neighbours of the trial
/// position. `largest` bounds h at the trial position: bins were made for no larger one. `near` gives sums(group, at)
/// and energy(group, at).
template <class Group, class Near, class Surface>
NACRE_HD inline RelaxedParticle relax_particle(Group& group, const Near& near, unsigned char* scratch,
                                               const Surface& surface, const SolverParameters& parameters,
                                               std::uint32_t interface, int order, float largest, const Mover& start,
                                               float first_damping) {
  const PairSums e = near.sums(group, start);
  RelaxedParticle result{start, e.energy, first_damping, false};
  if (!(e.neighbours > 0) || order == 0) return result;
  const float longest = parameters.step * start.h;
  for (float damping = first_damping; damping < parameters.most_damping; damping *= parameters.damping_factor) {
    Vec3f v;
    if (!detail::damped_step(e, start.direction, order, damping, v)) continue;
    const float size = length(v);
    if (size < parameters.still * start.h) return result;
    if (size > longest) v *= longest / size;
    Mover trial;
    if (!project_onto(group, scratch, surface, interface, start.p + v, parameters.reach * start.h, trial.p,
                      trial.direction))
      continue;
    if (dot(trial.p - start.p, trial.p - start.p) > longest * longest) continue;
    const float h = surface.size(trial.p);
    trial.h = h < largest ? h : largest;
    const float energy = near.energy(group, trial);
    if (energy < e.energy) {
      const float eased = damping / parameters.damping_factor;
      return {trial, energy, eased > parameters.least_damping ? eased : parameters.least_damping, true};
    }
  }
  return result;  // with the damping it came with
}

}  // namespace nacre
