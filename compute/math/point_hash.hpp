// Nacre: a hash of positions.
#pragma once

#include <bit>
#include <cstdint>

#include "compute/math/vec.hpp"

namespace nacre {

/// Goes on from `hash` with a position; -0 is 0. The high bits are the better mixed ones.
inline std::uint64_t hash_point(std::uint64_t hash, const Vec3d& point) {
  for (const double x : {point.x, point.y, point.z})
    hash = (std::rotl(hash, 21) ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u;
  return hash;
}

}  // namespace nacre
