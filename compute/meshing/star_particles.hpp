// Nacre: particles as stars need them.
#pragma once

#include <cstdint>
#include <span>

#include "compute/field/interface.hpp"
#include "compute/math/lanes.hpp"

namespace nacre {

/// All spans have an entry for each particle but the last one.
struct StarParticles {
  std::span<const Float4> position;   ///< x, y, z; h
  std::span<const Float4> direction;  ///< unit normal of a surface, towards its lower material
  std::span<const Junction> junction;
  std::span<const JunctionGradients> gradient;  ///< of those on curves and at points alone, in the same order

  std::size_t count() const { return position.size(); }
  Vec3d point(std::size_t i) const { return {position[i].x, position[i].y, position[i].z}; }
};

/// The same as kernels read it.
struct StarParticlesView {
  const Float4* position;
  const Float4* direction;
  const Junction* junction;
  const JunctionGradients* gradient;
  const std::uint32_t* gradients_before;  ///< per particle: how many of those before it have gradients

  NACRE_HD Vec3d point(std::int64_t i) const { return {position[i].x, position[i].y, position[i].z}; }
  NACRE_HD double size(std::int64_t i) const { return position[i].w; }
  /// Gradient of the function of material i of the junction less that of its material j.
  NACRE_HD Vec3d difference(std::int64_t particle, int i, int j) const {
    const JunctionGradients& g = gradient[gradients_before[particle]];
    const Vec3d to_i = i == 0 ? Vec3d() : Vec3d(g.from_first[i - 1]),
                to_j = j == 0 ? Vec3d() : Vec3d(g.from_first[j - 1]);
    return to_j - to_i;
  }
};

}  // namespace nacre
