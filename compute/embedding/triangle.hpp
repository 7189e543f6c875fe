// Nacre: geometry of one triangle: closest point, overlap with a box, barycentric coordinates.
#pragma once

#include "compute/grid/vec.hpp"

namespace nacre {

/// A triangle by its corners, in any unit.
struct Corners {
  Vec3d a, b, c;
};

NACRE_HD inline Corners operator*(const Corners& t, double s) { return {t.a * s, t.b * s, t.c * s}; }

/// Point of the triangle closest to `p`: the projection falls in one of seven regions, the face, three edges or three
/// corners (sec. 5.1.1, Fig. 5.2). Exact also for slivers, since it is done in double; a triangle without area is
/// treated by its edges.
NACRE_HD inline Vec3d closest_point(const Corners& t, const Vec3d& p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t.a;

  const Vec3d bp = p - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t.b;

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.a + ab * (d1 > d3 ? d1 / (d1 - d3) : 0.0);

  const Vec3d cp = p - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t.c;

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.a + ac * (d2 > d6 ? d2 / (d2 - d6) : 0.0);

  const double va = d3 * d6 - d5 * d4;
  const double along = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return t.b + (t.c - t.b) * (along > 0 ? (d4 - d3) / along : 0.0);

  const double sum = va + vb + vc;
  return t.a + ab * (vb / sum) + ac * (vc / sum);
}

/// Weights of the corners at a point of the triangle's plane, clamped to the triangle (they sum to one).
NACRE_HD inline Vec3d barycentric(const Corners& t, const Vec3d& p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  const double pb = dot(ap, ab), pc = dot(ap, ac);
  const double area = bb * cc - bc * bc;
  if (!(area > 0)) {  // a needle: by its longer edge
    const double v = bb >= cc ? (bb > 0 ? pb / bb : 0) : 0;
    const double w = bb >= cc ? 0 : pc / cc;
    return {1 - v - w, v, w};
  }
  double v = (cc * pb - bc * pc) / area;
  double w = (bb * pc - bc * pb) / area;
  double u = 1 - v - w;
  u = u > 0 ? u : 0;
  v = v > 0 ? v : 0;
  w = w > 0 ? w : 0;
  const double sum = u + v + w;
  return {u / sum, v / sum, w / sum};
}

namespace detail {
NACRE_HD inline bool separated(double p0, double p1, double p2, double reach) {
  const double low = p0 < p1 ? (p0 < p2 ? p0 : p2) : (p1 < p2 ? p1 : p2);
  const double high = p0 > p1 ? (p0 > p2 ? p0 : p2) : (p1 > p2 ? p1 : p2);
  return low > reach || high < -reach;
}

/// Tests the three axes cross(edge, unit axis).
NACRE_HD inline bool separated_by_edge(const Corners& t, const Vec3d& e, double half) {
  const double ex = e.x < 0 ? -e.x : e.x, ey = e.y < 0 ? -e.y : e.y, ez = e.z < 0 ? -e.z : e.z;
  return separated(t.a.z * e.y - t.a.y * e.z, t.b.z * e.y - t.b.y * e.z, t.c.z * e.y - t.c.y * e.z, half * (ez + ey)) ||
         separated(t.a.x * e.z - t.a.z * e.x, t.b.x * e.z - t.b.z * e.x, t.c.x * e.z - t.c.z * e.x, half * (ez + ex)) ||
         separated(t.a.y * e.x - t.a.x * e.y, t.b.y * e.x - t.b.x * e.y, t.c.y * e.x - t.c.x * e.y, half * (ey + ex));
}
}  // namespace detail

/// Whether the triangle touches the closed cube of half edge `half` around `centre` (separating axes).
NACRE_HD inline bool touches_cube(const Corners& triangle, const Vec3d& centre, double half) {
  const Corners t{triangle.a - centre, triangle.b - centre, triangle.c - centre};
  for (int axis = 0; axis < 3; ++axis)
    if (detail::separated(t.a[axis], t.b[axis], t.c[axis], half)) return false;
  const Vec3d ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
  const Vec3d n = cross(ab, bc);
  const double nx = n.x < 0 ? -n.x : n.x, ny = n.y < 0 ? -n.y : n.y, nz = n.z < 0 ? -n.z : n.z;
  const double d = dot(n, t.a), reach = half * (nx + ny + nz);
  if (d > reach || d < -reach) return false;
  return !detail::separated_by_edge(t, ab, half) && !detail::separated_by_edge(t, bc, half) &&
         !detail::separated_by_edge(t, ca, half);
}

}  // namespace nacre
