// Nacre: closed surfaces and fields on them whose topology is known, for the tests of topology.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/topology/tangent_field.hpp"

namespace nacre::test {

struct Shape {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
};

/// The unit sphere from an octahedron that was divided `levels` times, turned so that no point is anywhere special.
inline Shape divided_sphere(int levels) {
  Shape s;
  s.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), std::uint32_t(s.points.size()));
      if (is_new) s.points.push_back(normalized(s.points[a] + s.points[b]));
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : s.triangles) {
      const std::uint32_t ab = middle(t.a, t.b), bc = middle(t.b, t.c), ca = middle(t.c, t.a);
      for (const Triangle& each : {Triangle{t.a, ab, ca}, {ab, t.b, bc}, {ca, bc, t.c}, {ab, bc, ca}})
        finer.push_back(each);
    }
    s.triangles = finer;
  }
  const Vec3d x = normalized(Vec3d(1, 0.31, -0.17)), y = normalized(cross(Vec3d(0.23, -0.4, 1), x)), z = cross(x, y);
  for (Vec3d& p : s.points) p = x * p.x + y * p.y + z * p.z;
  return s;
}

/// Radii 1 and 0.4 about the z axis, `n` points around the small circle.
inline Shape torus(int n) {
  Shape s;
  const int m = 3 * n;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j) {
      const double a = 6.283185307179586 * (i + 0.3 * j / n) / m, b = 6.283185307179586 * (j + 0.37) / n;
      const double r = 1 + 0.4 * std::cos(b);
      s.points.push_back({r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)});
    }
  const auto at = [&](int i, int j) { return std::uint32_t((i % m) * n + j % n); };
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return s;
}

/// The unit square in n x n cells, all its diagonals alike.
inline Shape square(int n) {
  Shape s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) s.points.push_back({double(i) / n - 0.513, double(j) / n - 0.507, 0});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto a = std::uint32_t(j * (n + 1) + i), d = a + std::uint32_t(n + 1);
      s.triangles.push_back({a, a + 1, d});
      s.triangles.push_back({a + 1, d + 1, d});
    }
  return s;
}

/// One vector per point; `noise`: standard deviation of each component, as a share of the largest vector.
inline std::vector<Vec3f> vectors_on(const Shape& shape, const std::function<Vec3d(const Vec3d&)>& field,
                                     double noise = 0, unsigned seed = 1) {
  std::vector<Vec3d> exact;
  double largest = 0;
  for (const Vec3d& p : shape.points) {
    exact.push_back(field(p));
    largest = std::max(largest, length(exact.back()));
  }
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise * largest + 1e-300);
  std::vector<Vec3f> result;
  for (const Vec3d& v : exact)
    result.push_back(Vec3f(noise > 0 ? v + Vec3d(normal(random), normal(random), normal(random)) : v));
  return result;
}

/// The part of a vector that is tangential to the unit sphere.
inline Vec3d on_sphere(const Vec3d& v, const Vec3d& p) { return v - p * dot(v, p); }

}  // namespace nacre::test
