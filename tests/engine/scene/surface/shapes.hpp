// Nacre: small closed surfaces for the tests of this folder.
#pragma once

#include <utility>

#include "engine/scene/surface/surface.hpp"
#include "tests/icosphere.hpp"

namespace nacre::test {

/// The cube [-1, 1]^3: 8 points, 12 triangles, outward.
inline Surface cube() {
  Surface s;
  for (int i = 0; i < 8; ++i) s.points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    s.triangles.push_back({q[0], q[1], q[2]});
    s.triangles.push_back({q[0], q[2], q[3]});
  }
  return s;
}

/// A unit sphere of 20 * 4^levels triangles, outward.
inline Surface icosphere(int levels) {
  Icosphere unit = unit_icosphere(levels);
  Surface s;
  s.points = std::move(unit.points);
  s.triangles = std::move(unit.triangles);
  return s;
}

/// Six times the enclosed volume; positive where the triangles face outwards.
inline double six_volumes(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += dot(points[t.a], cross(points[t.b], points[t.c]));
  return sum;
}

}  // namespace nacre::test
