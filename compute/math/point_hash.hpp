// Nacre: a hash of positions.
#pragma once

#include <cstdint>
#include <cstring>

#include "compute/math/vec.hpp"

namespace nacre {

/// Goes on from `hash` with a position; -0 is 0. The high bits are the better mixed ones.
NACRE_HD inline std::uint64_t hash_point(std::uint64_t hash, const Vec3d& point) {
  for (int axis = 0; axis < 3; ++axis) {
    const double x = point[axis] + 0.0;
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof(bits));
    hash = ((hash << 21 | hash >> 43) ^ bits) * 0x9e3779b97f4a7c15u;
  }
  return hash;
}

}  // namespace nacre
