// Nacre: small surfaces and measures for the GPU tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre::gpu_tests {

/// A surface in host memory that a FlowMesh can look at.
struct Shape {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  std::vector<Vec3f> corner_normals;

  FlowMesh mesh() const { return {points, triangles, corner_normals}; }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.push_back({a, b, c});
    const Vec3f n(normalized(cross(points[b] - points[a], points[c] - points[a])));
    corner_normals.insert(corner_normals.end(), {n, n, n});
  }
};

/// A torus about z, radii 1 and 0.4, of 2 * around * across triangles, `scale` times as large.
inline Shape torus(int around, int across, double scale = 1) {
  const double turn = 2 * 3.14159265358979323846;
  Shape shape;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = turn * i / around, b = turn * j / across, r = 1 + 0.4 * std::cos(b);
      shape.points.push_back(Vec3d(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)) * scale);
    }
  auto at = [&](int i, int j) { return std::uint32_t(i % around * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      shape.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      shape.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return shape;
}

/// A slanted box of twelve triangles: each is as wide as the whole grid.
inline Shape box() {
  Shape shape;
  for (int k = 0; k < 8; ++k) {
    const double x = k & 1 ? 1 : 0, y = k & 2 ? 0.7 : 0, z = k & 4 ? 0.5 : 0;
    shape.points.push_back({x - 0.2 * y, 0.2 * x + y + 0.1 * z, z - 0.15 * x});
  }
  constexpr std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    shape.add(f[0], f[1], f[2]);
    shape.add(f[0], f[2], f[3]);
  }
  return shape;
}

/// Pearson's correlation of two arrays of one length; 0 where one is constant.
inline double correlation(std::span<const float> a, std::span<const float> b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i], mb += b[i];
  ma /= double(a.size());
  mb /= double(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double da = a[i] - ma, db = b[i] - mb;
    ab += da * db;
    aa += da * da;
    bb += db * db;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

template <class T>
double mean_difference(const std::vector<T>& a, const std::vector<T>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::fabs(double(a[i]) - double(b[i]));
  return a.empty() ? 0 : sum / double(a.size());
}

}  // namespace nacre::gpu_tests
