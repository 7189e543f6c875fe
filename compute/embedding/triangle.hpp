// Nacre: geometry of one triangle: closest point, overlap with a box, barycentric coordinates.
#pragma once

#include "compute/math/vec.hpp"

namespace nacre {

/// A triangle by its corners, in any unit.
struct Corners {
  Vec3d a, b, c;
};

NACRE_HD inline Corners operator*(const Corners& t, double s) { return {t.a * s, t.b * s, t.c * s}; }

namespace detail {
/// Weights of the corners at the point of the three edges closest to `p`.
NACRE_HD inline Vec3d closest_edge_weights(const Corners& t, const Vec3d& p) {
  const Vec3d corner[3] = {t.a, t.b, t.c};
  Vec3d weights;
  double nearest = 1e300;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Vec3d edge = corner[next] - corner[k], away = p - corner[k];
    const double along = dot(edge, away), l = dot(edge, edge);
    const double s = along <= 0 ? 0 : along >= l ? 1 : along / l;
    const Vec3d d = edge * s - away;
    if (dot(d, d) >= nearest) continue;
    nearest = dot(d, d);
    weights = {};
    weights[k] = 1 - s;
    weights[next] += s;
  }
  return weights;
}

/// The closest point if the triangle is too thin for the seven regions: the foot on its plane if that is inside,
/// otherwise the closest point of its edges.
NACRE_HD inline Vec3d closest_point_of_sliver(const Corners& t, const Vec3d& p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, n = cross(ab, ac);
  const double nn = dot(n, n), bb = dot(ab, ab), cc = dot(ac, ac), longest = bb > cc ? bb : cc;
  if (nn > 1e-18 * longest * longest) {  // if even thinner, the normal is rounding, too, and the edges are as good
    const Vec3d foot = p - t.a - n * (dot(n, p - t.a) / nn);
    if (dot(cross(ab, foot), n) >= 0 && dot(cross(foot, ac), n) >= 0 && dot(cross(t.c - t.b, foot - ab), n) >= 0)
      return t.a + foot;
  }
  const Vec3d w = closest_edge_weights(t, p);
  return t.a * w.x + t.b * w.y + t.c * w.z;
}

NACRE_HD inline double magnitude(double a, double b, double c) {
  return (a < 0 ? -a : a) + (b < 0 ? -b : b) + (c < 0 ? -c : c);
}
}  // namespace detail

/// Point of the triangle closest to `p`: the projection lies in one of seven regions, the face, three edges or three
/// corners (thesis, sec. 5.1.1, Fig. 5.2). Correct for slivers, too; a triangle without area is treated by its edges.
NACRE_HD inline Vec3d closest_point(const Corners& t, const Vec3d& p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t.a;

  const Vec3d bp = p - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t.b;

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return t.a + ab * (d1 / (d1 - d3));

  const Vec3d cp = p - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t.c;

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return t.a + ac * (d2 / (d2 - d6));

  const double va = d3 * d6 - d5 * d4;
  const double along = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && along > 0) return t.b + (t.c - t.b) * ((d4 - d3) / along);

  // va, vb, vc are differences of such products: for a sliver they are nothing but rounding.
  const double sum = va + vb + vc;
  if (!(sum > 1e-8 * detail::magnitude(d1, d3, d5) * detail::magnitude(d2, d4, d6)))
    return detail::closest_point_of_sliver(t, p);
  return t.a + ab * (vb / sum) + ac * (vc / sum);
}

/// Weights of the corners at a point of the triangle, all in [0, 1], with sum one. For a point beside it, those of a
/// point of its edges.
NACRE_HD inline Vec3d barycentric(const Corners& t, const Vec3d& p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a, n = cross(ab, ac);
  const double area = dot(n, n);
  if (!(area > 1e-14 * dot(ab, ab) * dot(ac, ac))) return detail::closest_edge_weights(t, p);
  const double per_area = 1 / area;  // divisions are what this function waits for
  double v = dot(cross(ap, ac), n) * per_area, w = dot(cross(ab, ap), n) * per_area;
  double u = 1 - v - w;
  const double outside = -1e-6;  // farther than rounding could move a point of the triangle
  if (u < outside || v < outside || w < outside) return detail::closest_edge_weights(t, p);
  u = u > 0 ? u : 0;
  v = v > 0 ? v : 0;
  w = w > 0 ? w : 0;
  const double scale = 1 / (u + v + w);
  return {u * scale, v * scale, w * scale};
}

/// `barycentric` in single precision but for the differences of positions: consumer GPUs have a 64th of the rate in
/// double. Off by 1e-5 at most: rounding (6e-8, a handful of operations each) over the triangle's area, which is at
/// least a tenth of the square of its longest edge at the first corner. Thinner triangles, and points beside, take the
/// other function.
NACRE_HD inline Vec3f barycentric_in_float(const Corners& t, const Vec3d& p) {
  const Vec3f ab(t.b - t.a), ac(t.c - t.a), ap(p - t.a), n = cross(ab, ac);
  const float area = dot(n, n), bb = dot(ab, ab), cc = dot(ac, ac), longest = bb > cc ? bb : cc;
  if (!(area > 1e-2f * longest * longest)) return Vec3f(barycentric(t, p));
  const float per_area = 1 / area;
  float v = dot(cross(ap, ac), n) * per_area, w = dot(cross(ab, ap), n) * per_area;
  float u = 1 - v - w;
  const float outside = -1e-5f;
  if (u < outside || v < outside || w < outside) return Vec3f(barycentric(t, p));
  u = u > 0 ? u : 0;
  v = v > 0 ? v : 0;
  w = w > 0 ? w : 0;
  const float scale = 1 / (u + v + w);
  return {u * scale, v * scale, w * scale};
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
  // The normal of a needle is mostly rounding; its length must not turn that into a distance.
  const double rounding = 1e-15 * detail::magnitude(t.a.x, t.a.y, t.a.z) *
                          (detail::magnitude(ab.x, ab.y, ab.z) + half) * (detail::magnitude(bc.x, bc.y, bc.z) + half);
  const double d = dot(n, t.a), reach = half * (nx + ny + nz) + rounding;
  if (d > reach || d < -reach) return false;
  return !detail::separated_by_edge(t, ab, half) && !detail::separated_by_edge(t, bc, half) &&
         !detail::separated_by_edge(t, ca, half);
}

}  // namespace nacre
