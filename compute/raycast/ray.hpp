// Nacre: a ray, and where it meets a triangle.
#pragma once

#include <cmath>

#include "compute/embedding/band.hpp"
#include "compute/embedding/closest_point_grid.hpp"

namespace nacre {

/// A ray in cells; `direction` need not be a unit vector. Double, since the domain of an octree may be 2^20 cells wide.
struct Ray {
  Vec3d origin, direction;
  bool fronts_only = false;  ///< passes through triangles that face away from where it begins

  NACRE_HD_INLINE Vec3d at(double t) const { return origin + direction * t; }
};

struct Hit {
  double t = 1e300;
  std::uint32_t triangle = none;
  Vec3f weights{};  ///< barycentric coordinates
};

namespace detail {
template <class T>
NACRE_HD_INLINE T sum_of_magnitudes(const Vec3<T>& v) {
  return (v.x < 0 ? -v.x : v.x) + (v.y < 0 ? -v.y : v.y) + (v.z < 0 ? -v.z : v.z);
}

/// How far outside of a triangle a ray may pass and still hit it, in barycentric coordinates. Neighbours overlap, so
/// that no ray slips through between them.
inline constexpr double edge_slack = 1e-5;

/// Whether single precision proves that the ray misses the triangle; `a`, `ab`, `ac` are its first corner relative to
/// the ray's origin, and its sides.
NACRE_HD inline bool surely_misses(const Vec3f& a, const Vec3f& ab, const Vec3f& ac, const Vec3f& direction) {
  const Vec3f p = cross(direction, ac), q = cross(ab, a);
  const float determinant = dot(ab, p), sign = determinant < 0 ? -1.0f : 1.0f;
  const float v = -dot(a, p) * sign, w = dot(direction, q) * sign, whole = determinant * sign;
  // Some ten roundings of products of three factors, and those of the sides and the origin.
  const float size = sum_of_magnitudes(direction) * (sum_of_magnitudes(a) + sum_of_magnitudes(ab)) *
                     (sum_of_magnitudes(ab) + sum_of_magnitudes(ac));
  const float slack = -(2 * float(edge_slack) * whole + 2e-6f * size);
  return v < slack || w < slack || v + w > whole - slack;
}
}  // namespace detail

/// Ray against triangle, both sides (Moeller-Trumbore). Keeps the nearer hit in `hit`; of two at one position, that
/// with the lower triangle. Most triangles are rejected in single precision. The rest is done in double precision, so
/// that `t` is accurate for grazing rays and for large triangles.
NACRE_HD inline void intersect(const MeshView& mesh, std::uint32_t t, const Ray& ray, Hit& hit) {
  const Corners c = mesh.corners(t);
  const Vec3d a = c.a - ray.origin, ab = c.b - c.a, ac = c.c - c.a;
  if (detail::surely_misses(Vec3f(a), Vec3f(ab), Vec3f(ac), Vec3f(ray.direction))) return;
  const Vec3d p = cross(ray.direction, ac), q = cross(ab, a);
  const double determinant = dot(ab, p);
  if (determinant == 0 || (ray.fronts_only && determinant < 0)) return;
  const double inverse = 1 / determinant, slack = -detail::edge_slack;
  const double v = -dot(a, p) * inverse;
  if (!(v >= slack)) return;
  const double w = dot(ray.direction, q) * inverse;
  if (!(w >= slack) || !(v + w <= 1 - slack)) return;
  const double distance = dot(ac, q) * inverse;
  if (!(distance > 0) || distance > hit.t || (distance == hit.t && t >= hit.triangle)) return;
  hit = {distance, t, Vec3f(Vec3d(1 - v - w, v, w))};
}

}  // namespace nacre
