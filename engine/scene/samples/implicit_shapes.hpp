// Nacre: signed distances of simple bodies, and smooth ways to join and cut them.
#pragma once

#include <algorithm>
#include <cmath>

#include "compute/math/vec.hpp"

namespace nacre {

/// Length of (u, v); much faster than std::hypot, whose care for extreme values is not needed here.
inline double norm(double u, double v) { return std::sqrt(u * u + v * v); }

/// Distance to the convex hull of two circles (or spheres) of radii `r1` at 0 and `r2` at `apart` on an axis, for a
/// point at `along` on that axis and `off` from it. Where one circle holds the other it is the distance to the larger.
inline double round_cone(double along, double off, double apart, double r1, double r2) {
  const double sine = std::clamp((r1 - r2) / apart, -1.0, 1.0);  // the common tangent's normal is (sine, cosine)
  const double cosine = std::sqrt(1 - sine * sine);
  off = std::abs(off);
  const double tangent = cosine * along - sine * off;
  if (tangent < 0) return norm(along, off) - r1;
  if (tangent > cosine * apart) return norm(along - apart, off) - r2;
  return sine * along + cosine * off - r1;
}

/// Distance to the hull of the spheres of radius `r1` about `a` and `r2` about `b`.
inline double round_cone(const Vec3d& p, const Vec3d& a, const Vec3d& b, double r1, double r2) {
  const double apart = length(b - a);
  const Vec3d axis = (b - a) / apart;
  const double along = dot(p - a, axis);
  return round_cone(along, length(p - a - axis * along), apart, r1, r2);
}

/// Union of two bodies with a fillet of about radius `k`.
inline double smooth_union(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * h * k / 6;
}

/// `a` without `b`, its new edges rounded by about `k`.
inline double smooth_cut(double a, double b, double k) { return -smooth_union(-a, b, k); }

/// The body that is `profile` wide in one plane and `half` high across it, its edges rounded by `radius`.
inline double rounded_extrusion(double profile, double height, double half, double radius) {
  const double u = profile + radius, v = std::abs(height) - half + radius;
  return std::min(std::max(u, v), 0.0) + norm(std::max(u, 0.0), std::max(v, 0.0)) - radius;
}

}  // namespace nacre
