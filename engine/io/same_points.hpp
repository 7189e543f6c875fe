// Nacre: whether the points of two steps of a series are the same.
#pragma once

#include <cstddef>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Fraction of a surface's size below which a difference between two steps is rounding, not motion.
inline constexpr double least_motion = 1e-6;

/// `size`: of the surface.
inline bool differ(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, double size) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] == b[i]) && is_finite(a[i]) && !(length(a[i] - b[i]) <= least_motion * size)) return true;
  return false;
}

}  // namespace nacre
