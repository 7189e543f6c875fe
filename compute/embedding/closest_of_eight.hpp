// Nacre: the points of a triangle closest to the eight corners of a cube, in double precision.
#pragma once

#include <cmath>

#include "compute/embedding/triangle.hpp"
#include "compute/math/eight.hpp"

namespace nacre {

#if !defined(__CUDACC__)

/// For each corner of a cube (x fastest, lower ones first): the displacement to the closest point, and its squared
/// length.
struct ClosestOfEight {
  EightDoubles x, y, z, squared;
};

/// `closest_point` for the corners of the cube around `centre` with half edge `half`; all seven regions are computed
/// and one is selected. False, without a result, if the triangle is too thin for that.
NACRE_HD_INLINE bool closest_of_eight(const Corners& t, const Vec3d& centre, double half, ClosestOfEight& found) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, p = centre - t.a, n = cross(ab, ac);
  const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), area = dot(n, n);
  const double along_b = dot(ab, p), along_c = dot(ac, p);
  const double most_b = std::fabs(along_b) + half * detail::magnitude(ab.x, ab.y, ab.z) + bb + std::fabs(bc);
  const double most_c = std::fabs(along_c) + half * detail::magnitude(ac.x, ac.y, ac.z) + cc + std::fabs(bc);
  if (!(area > 1e-7 * most_b * most_c)) return false;

  const EightDoubles d1 = at_corners(along_b, ab.x * half, ab.y * half, ab.z * half), d3 = d1 - bb, d5 = d1 - bc;
  const EightDoubles d2 = at_corners(along_c, ac.x * half, ac.y * half, ac.z * half), d4 = d2 - bc, d6 = d2 - cc;
  const EightDoubles vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const EightDoubles to_c = d4 - d3, to_b = d5 - d6, zero = d1 - d1;
  EightDoubles v = vb * (1 / area), w = vc * (1 / area);  // the weights of B and C on the face
  const auto on_bc = (va <= 0) & (to_c >= 0) & (to_b >= 0), on_ac = (vb <= 0) & (d2 >= 0) & (d6 <= 0),
             on_ab = (vc <= 0) & (d1 >= 0) & (d3 <= 0), at_a = (d1 <= 0) & (d2 <= 0), at_b = (d3 >= 0) & (d4 <= d3),
             at_c = (d6 >= 0) & (d5 <= d6);
  const EightDoubles s = to_c * (1 / (bb - 2 * bc + cc));
  v = on_bc ? 1 - s : v, w = on_bc ? s : w;
  v = on_ac ? zero : v, w = on_ac ? d2 * (1 / cc) : w;
  v = on_ab ? d1 * (1 / bb) : v, w = on_ab ? zero : w;
  v = at_c ? zero : v, w = at_c ? zero + 1 : w;
  v = at_b ? zero + 1 : v, w = at_b ? zero : w;
  v = at_a ? zero : v, w = at_a ? zero : w;
  // Computed from the point itself, whose rounding hides that of the weights: most triangles that share the point tie.
  found.x = (ab.x * v + ac.x * w + t.a.x) - at_corners(centre.x, half, 0.0, 0.0);
  found.y = (ab.y * v + ac.y * w + t.a.y) - at_corners(centre.y, 0.0, half, 0.0);
  found.z = (ab.z * v + ac.z * w + t.a.z) - at_corners(centre.z, 0.0, 0.0, half);
  found.squared = found.x * found.x + found.y * found.y + found.z * found.z;
  return true;
}

#endif

}  // namespace nacre
