// Nacre: closest points the slow and careful way, for tests to compare with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "compute/embedding/triangle.hpp"
#include "compute/math/vec.hpp"

namespace nacre::test {

using Vec3l = Vec3<long double>;

inline Vec3l closest_on_segment(const Vec3l& a, const Vec3l& b, const Vec3l& p) {
  const Vec3l ab = b - a;
  const long double l = dot(ab, ab);
  return l > 0 ? a + ab * std::clamp(dot(p - a, ab) / l, 0.0L, 1.0L) : a;
}

/// The nearest of the closest points of the three edges and, where it falls inside, the foot on the plane.
inline Vec3d reference_closest_point(const Corners& t, const Vec3d& point) {
  const Vec3l a(t.a), b(t.b), c(t.c), p(point), n = cross(b - a, c - a);
  Vec3l best = closest_on_segment(a, b, p);
  auto offer = [&](const Vec3l& q) {
    if (dot(q - p, q - p) < dot(best - p, best - p)) best = q;
  };
  offer(closest_on_segment(b, c, p));
  offer(closest_on_segment(c, a, p));
  if (dot(n, n) > 0) {
    const Vec3l q = p - n * (dot(n, p - a) / dot(n, n));
    if (dot(cross(b - a, q - a), n) >= 0 && dot(cross(c - b, q - b), n) >= 0 && dot(cross(a - c, q - c), n) >= 0)
      offer(q);
  }
  return Vec3d(best);
}

/// Closest points over all triangles of a mesh. Only triangles that provably lie too far are left out.
class BruteForce {
 public:
  struct Nearest {
    Vec3d point{};
    double distance = 1e300;
    std::uint32_t triangle = 0xffffffffu;
    bool unique = true;  ///< no other point of the surface, 1e-5 or more away, is as near (to 1e-6)
  };

  BruteForce(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles) {
    for (const Triangle& t : triangles) {
      const Corners c{points[t.a], points[t.b], points[t.c]};
      const Vec3d g = (c.a + c.b + c.c) / 3.0;
      corners_.push_back(c);
      centre_.push_back(g);
      reach_.push_back(std::max({length(c.a - g), length(c.b - g), length(c.c - g)}) * 1.0000001);
    }
  }

  const Corners& corners(std::uint32_t t) const { return corners_[t]; }
  std::size_t size() const { return corners_.size(); }

  /// Nearest point to `x` if it is nearer than `limit`; `hint` names a triangle to look at first.
  Nearest operator()(const Vec3d& x, double limit = 1e300, std::uint32_t hint = 0xffffffffu) const {
    Nearest best;
    best.distance = limit;
    if (hint < size()) offer(best, hint, x);
    for (std::uint32_t t = 0; t < size(); ++t)
      if (t != hint && !farther(t, x, best.distance)) offer(best, t, x);
    if (best.triangle == 0xffffffffu) return best;
    for (std::uint32_t t = 0; t < size() && best.unique; ++t) {
      if (t == best.triangle || farther(t, x, best.distance + 1e-6)) continue;
      const Vec3d p = reference_closest_point(corners_[t], x);
      best.unique = length(p - x) > best.distance + 1e-6 || length(p - best.point) < 1e-5;
    }
    return best;
  }

 private:
  bool farther(std::uint32_t t, const Vec3d& x, double distance) const {
    const Vec3d d = centre_[t] - x;
    const double reach = distance + reach_[t];
    return dot(d, d) > reach * reach * (1 + 1e-12);
  }

  void offer(Nearest& best, std::uint32_t t, const Vec3d& x) const {
    const Vec3d p = reference_closest_point(corners_[t], x);
    const double d = length(p - x);
    if (d < best.distance) best = {p, d, t, true};
  }

  std::vector<Corners> corners_;
  std::vector<Vec3d> centre_;
  std::vector<double> reach_;
};

}  // namespace nacre::test
