// Nacre: points on surfaces with known answers, and the materials around them.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/delaunay.hpp"

namespace nacre::test {

/// `count` points spread evenly over a sphere (a Fibonacci lattice).
inline std::vector<Vec3d> points_on_sphere(int count, double radius, const Vec3d& centre = {}) {
  std::vector<Vec3d> points;
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    points.push_back(centre + radius * Vec3d(r * std::cos(turn * i), r * std::sin(turn * i), z));
  }
  return points;
}

/// Two balls of radius 1 around (-d, 0, 0) and (d, 0, 0); they meet in the disc x = 0, which parts them. Material 1 is
/// on the left, 2 on the right. Points, spacing about `h`: on the caps, on the disc, and on the circle where all three
/// meet.
inline std::vector<Vec3d> points_on_double_bubble(double d, double h) {
  const double rim = std::sqrt(1 - d * d);
  std::vector<Vec3d> points;
  const int around = int(2 * std::numbers::pi * rim / h);
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    points.push_back({0, rim * std::cos(angle), rim * std::sin(angle)});
  }
  const int on_sphere = int(4 * std::numbers::pi / (0.866 * h * h));
  for (const double side : {-1.0, 1.0})
    for (const Vec3d& p : points_on_sphere(on_sphere, 1, {side * d, 0, 0}))
      if (side * p.x > 0.6 * h) points.push_back(p);
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  const int on_disc = int(std::numbers::pi * rim * rim / (0.866 * h * h));
  for (int i = 0; i < on_disc; ++i) {
    const double r = rim * std::sqrt((i + 0.5) / on_disc);
    if (r < rim - 0.6 * h) points.push_back({0, r * std::cos(turn * i), r * std::sin(turn * i)});
  }
  return points;
}

inline std::uint16_t double_bubble_material(double d, const Vec3d& p) {
  const Vec3d left = p - Vec3d(-d, 0, 0), right = p - Vec3d(d, 0, 0);
  if (p.x < 0) return dot(left, left) < 1 ? 1 : 0;
  return dot(right, right) < 1 ? 2 : 0;
}

/// The material at each cell's circumcentre.
template <class MaterialAt>
std::vector<std::uint16_t> labels_of(const DelaunayCells& cells, const MaterialAt& material_at) {
  std::vector<std::uint16_t> label;
  for (const Vec3d& c : cells.circumcentres) label.push_back(std::uint16_t(material_at(c)));
  return label;
}

}  // namespace nacre::test
