// Nacre: how far a surface reaches.
#pragma once

#include <algorithm>
#include <span>

#include "compute/math/vec.hpp"

namespace nacre {

/// Bounds of the points that triangles use, or of all; world units.
struct Extent {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  bool finite = true;  ///< all of them are

  explicit Extent(std::span<const Vec3d> points) {
    for (const Vec3d& p : points) add(p);
  }
  Extent(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k) add(points[t[k]]);
  }
  /// Without points, 0.
  Vec3d size() const { return low.x <= high.x ? high - low : Vec3d{}; }
  double longest_side() const {
    const Vec3d side = size();
    return std::max({side.x, side.y, side.z});
  }
  double diagonal() const { return length(size()); }

 private:
  void add(const Vec3d& p) {
    finite = finite && is_finite(p);
    low = min(low, p);
    high = max(high, p);
  }
};

}  // namespace nacre
