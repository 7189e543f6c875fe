// Nacre: how close a surface comes to itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Triangles by the cubes of edge `cube` that their boxes meet.
class TriangleCubes {
 public:
  TriangleCubes(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles, double cube) : cube_(cube) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const Vec3d &a = points[triangles[t].a], &b = points[triangles[t].b], &c = points[triangles[t].c];
      each_cube(min(a, min(b, c)), max(a, max(b, c)), [&](std::uint64_t key) { entries_.push_back({key, t}); });
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls visit(triangle), perhaps more than once each, for those whose box is near the box [low, high].
  template <class Visit>
  void near(const Vec3d& low, const Vec3d& high, const Visit& visit) const {
    each_cube(low, high, [&](std::uint64_t key) {
      for (auto e = std::lower_bound(entries_.begin(), entries_.end(), std::pair{key, 0u});
           e != entries_.end() && e->first == key; ++e)
        visit(e->second);
    });
  }

 private:
  template <class Visit>
  void each_cube(const Vec3d& low, const Vec3d& high, const Visit& visit) const {
    const auto at = [&](double x) { return std::int64_t(std::floor(x / cube_)) + (1 << 20); };
    for (std::int64_t z = at(low.z); z <= at(high.z); ++z)
      for (std::int64_t y = at(low.y); y <= at(high.y); ++y)
        for (std::int64_t x = at(low.x); x <= at(high.x); ++x) visit(std::uint64_t(x << 42 | y << 21 | z));
  }

  double cube_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> entries_;
};

/// The shortest way, square to the surface on either side, from any point of a mesh to another part of it; `most` where
/// there is none shorter. Triangles at the point itself do not count.
inline double least_gap(const std::vector<Vec3d>& points, const std::vector<Vec3d>& normals,
                        const std::vector<Triangle>& triangles, double most) {
  const TriangleCubes cubes(points, triangles, most);
  double least = most;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3d &p = points[i], &n = normals[i];
    cubes.near(p - Vec3d(most), p + Vec3d(most), [&](std::uint32_t t) {
      const Triangle& c = triangles[t];
      if (c.a == i || c.b == i || c.c == i) return;
      const Vec3d ab = points[c.b] - points[c.a], ac = points[c.c] - points[c.a], s = p - points[c.a];
      const Vec3d h = cross(n, ac), q = cross(s, ab);
      const double determinant = dot(ab, h), u = dot(s, h) / determinant, v = dot(n, q) / determinant;
      if (u >= 0 && v >= 0 && u + v <= 1) least = std::min(least, std::abs(dot(ac, q) / determinant));
    });
  }
  return least;
}

}  // namespace nacre
