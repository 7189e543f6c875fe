// Nacre: distances to a triangle from eight positions at once, in single precision and with a bound of the error.
#pragma once

#include <cmath>

#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/triangle.hpp"
#include "compute/math/eight.hpp"

namespace nacre {

/// A triangle in its own plane: corner A at the origin, B at (length, 0), C at (cu, cv) with cv >= 0. AB is its longest
/// edge, so that nothing is divided by a small number, however thin the triangle is.
struct TriangleFrame {
  Vec3d origin;
  Vec3f u, v, n;  ///< unit axes of the plane, and its normal
  float length, cu, cv;
  float ac_u, ac_v, ac_length;  ///< direction and length of AC
  float bc_u, bc_v, bc_length;

  /// Squares of the distances from the corners of the cube around `centre` with half edge `half`. Returns a bound of
  /// the error of the distances (not of their squares).
  NACRE_HD_INLINE float distances(const Vec3d& centre, float half, Eight& squared) const {
    const Vec3f w(centre - origin);
    const EightDisplacements displacements = displacements_to_corners(w, half);
    const Eight x = dot(displacements, u), y = dot(displacements, v), z = dot(displacements, n);
    const Eight zero = eight(0);

    const Eight beside_ab = max(max(zero - x, x - length), zero);
    Eight nearest = beside_ab * beside_ab + y * y;
    const Eight along_ac = x * ac_u + y * ac_v, side_ac = x * ac_v - y * ac_u;
    const Eight beside_ac = max(max(zero - along_ac, along_ac - ac_length), zero);
    nearest = min(nearest, beside_ac * beside_ac + side_ac * side_ac);
    const Eight xb = x - length;
    const Eight along_bc = xb * bc_u + y * bc_v, side_bc = y * bc_u - xb * bc_v;
    const Eight beside_bc = max(max(zero - along_bc, along_bc - bc_length), zero);
    nearest = min(nearest, beside_bc * beside_bc + side_bc * side_bc);

    const Eight inside = min(y, min(side_ac, side_bc));
    squared = z * z + where_positive(inside, zero, nearest);
    return 1e-6f * (std::fabs(w.x) + std::fabs(w.y) + std::fabs(w.z) + length + half);
  }
};

NACRE_HD inline TriangleFrame triangle_frame(const Corners& t) {
  const double ab = length(t.b - t.a), bc = length(t.c - t.b), ca = length(t.a - t.c);
  Corners s = t;  // its longest edge first, rotated and not mirrored
  if (bc >= ab && bc >= ca) s = {t.b, t.c, t.a};
  if (ca > ab && ca > bc) s = {t.c, t.a, t.b};
  const Vec3d e = s.b - s.a, other = s.c - s.a;
  const double l = length(e);
  Vec3d n = detail::plane_normal(s);
  const Vec3d u = l > 0 ? e / l : Vec3d(1, 0, 0);
  if (!(l > 0)) n = {0, 0, 1};
  const Vec3d v = cross(n, u);
  const double cu = dot(other, u), cv = std::fmax(dot(other, v), 0.0), ac = std::sqrt(cu * cu + cv * cv);
  const double bu = cu - l, bc_length = std::sqrt(bu * bu + cv * cv);
  TriangleFrame f{s.a, Vec3f(u), Vec3f(v),  Vec3f(n), float(l), float(cu),       float(cv),
                  1,   0,        float(ac), -1,       0,        float(bc_length)};
  if (ac > 0) f.ac_u = float(cu / ac), f.ac_v = float(cv / ac);
  if (bc_length > 0) f.bc_u = float(bu / bc_length), f.bc_v = float(cv / bc_length);
  return f;
}

}  // namespace nacre
