// Nacre: how far a surface reaches.
#pragma once

#include <algorithm>
#include <span>

#include "compute/math/vec.hpp"

namespace nacre {

/// Bounds of the points that triangles use; world units.
struct Extent {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  bool finite = true;  ///< all of them are

  Extent(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k) {
        const Vec3d& p = points[t[k]];
        finite = finite && is_finite(p);
        low = min(low, p);
        high = max(high, p);
      }
  }
  /// Without triangles, 0.
  Vec3d size() const { return low.x <= high.x ? high - low : Vec3d{}; }
  double longest_side() const {
    const Vec3d side = size();
    return std::max({side.x, side.y, side.z});
  }
  double diagonal() const { return length(size()); }
};

}  // namespace nacre
