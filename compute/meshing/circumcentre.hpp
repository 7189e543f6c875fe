// Nacre: circumcentres of tetrahedra that may be next to flat.
#pragma once

#include <algorithm>
#include <cmath>

#include "compute/math/vec.hpp"

namespace nacre {

/// Where circumcentres end, in longest edges of the cell, measured from its first corner. A farther one is put there,
/// in the right direction: the cell is all but flat, and its true centre lies beyond the precision of doubles.
inline constexpr double circumcentre_reach = 64;

/// Circumcentre of the tetrahedron (a, b, c, d), whose exact volume is positive; always finite for finite corners.
/// Where rounding made the volume zero or negative the direction is still that of a positive one.
inline Vec3d circumcentre(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  const double longest =
      std::sqrt(std::max({dot(u, u), dot(v, v), dot(w, w), dot(v - u, v - u), dot(w - u, w - u), dot(w - v, w - v)}));
  const Vec3d vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double six_volumes = dot(u, vw);
  const Vec3d towards = dot(u, u) * vw + dot(v, v) * wu + dot(w, w) * uv;
  const double reach = circumcentre_reach * longest;
  const double size = length(towards);
  if (!(size > 0) || !std::isfinite(size)) return 0.25 * (a + b + c + d);
  if (six_volumes > 0 && size <= 2 * six_volumes * reach) return a + towards / (2 * six_volumes);
  return a + (reach / size) * towards;
}

}  // namespace nacre
