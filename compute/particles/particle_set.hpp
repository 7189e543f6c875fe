// Nacre: the particles as arrays, and the rule by which their number is controlled. What all three solvers share.
#pragma once

#include <cstdint>
#include <string>

#include "compute/device/arena.hpp"
#include "compute/device/array.hpp"
#include "compute/device/error.hpp"
#include "compute/field/interface.hpp"
#include "compute/math/lanes.hpp"
#include "compute/particles/energy.hpp"

namespace nacre {

/// All particles that matter to one junction order: first the `fixed` ones of lower orders, then those that move.
/// Arrays are larger than `count` and hold nothing behind it.
struct ParticleSet {
  std::int64_t fixed = 0, count = 0;
  Array<Float4> position;          ///< x, y, z in voxels; h, the sizing field there
  Array<Float4> direction;         ///< unit normal (surface) or tangent (curve); the particle's energy
  Array<std::uint32_t> interface;  ///< number of its junction in the table of Junctions
  std::int64_t capacity() const { return std::int64_t(position.size()); }
};

/// Particles with room for `capacity`, in permanent memory: an Arena, or an AllocationPlan.
template <class Memory>
ParticleSet allocate_particle_set(Memory& memory, std::int64_t capacity) {
  ParticleSet set;
  set.position = memory.template permanent<Float4>(capacity);
  set.direction = memory.template permanent<Float4>(capacity);
  set.interface = memory.template permanent<std::uint32_t>(capacity);
  return set;
}

/// Throws Error where a set has no room for `count` particles.
inline void require_capacity(const ParticleSet& set, std::int64_t count) {
  if (count > set.capacity())
    throw Error("more particles than expected", std::to_string(count) + " of at most " + std::to_string(set.capacity()),
                "raise `min_size` or `epsilon`");
}

/// When particles are added and deleted (sec. 3.1.3: a random share of the deviation decides, so
/// that neighbours do not all split at once).
struct PopulationRule {
  float ideal_energy = hexagonal_energy;
  float add_below = 0.65f, delete_above = 1.75f;  ///< shares of the ideal energy
  bool by_density = true;                         ///< false: the original program's rule (see population_fate)
  float certain_above = 4;                        ///< deleted whatever chance says (a share, too)
  bool may_add = true;
  std::int64_t target = 0;  ///< tree: how many there shall be, within `slack`; 0: as the energies have it
  double slack = 0.05;      ///< share of the target
  std::uint32_t seed = 1;
};

/// What an iteration did.
struct IterationResult {
  double energy = 0;  ///< mean per moving particle
  std::int64_t added = 0, deleted = 0;
};

/// The size that scales the distance of two particles in the tree solver: the mean. With the smaller of the two, as Eq.
/// 3.2 has it, a particle's neighbours stand at its own distance where h grows and closer where it falls: triangles are
/// squeezed along the slope of h.
NACRE_HD_INLINE float pair_size(float h_p, float h_q) { return 0.5f * (h_p + h_q); }

/// The force on a particle at p from one at q: E, and dE/dp through the scaled distance |p - q| / (support pair_size)
/// (Eq. 3.2, 3.3 with the chain factor that is missing there).
struct PairForce {
  float energy;
  Vec3f gradient;   ///< of the energy with respect to p
  float stiffness;  ///< second derivative along the line between the two
};

NACRE_HD_INLINE PairForce pair_force(const Vec3f& p, float h_p, const Vec3f& q, float h_q) {
  const float unit = 1 / (support * pair_size(h_p, h_q));
  const Vec3f r = p - q;
  const float distance = std::sqrt(dot(r, r));
  const PairEnergy e = cotangent_energy(distance * unit);
  const float inverse = distance > 1e-12f ? 1 / distance : 0.0f;
  return {e.energy, r * (e.slope * unit * inverse), e.curve * unit * unit};
}

}  // namespace nacre
