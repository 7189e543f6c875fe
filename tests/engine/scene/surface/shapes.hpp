// Nacre: small closed surfaces for the tests of this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/scene/surface/surface.hpp"

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

/// A unit sphere: an icosahedron split `levels` times into 20 * 4^levels triangles, outward.
inline Surface icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Surface s;
  s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3d& p : s.points) p = normalized(p);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(s.points.size()));
      if (fresh) s.points.push_back(normalized(s.points[a] + s.points[b]));
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : s.triangles) {
      const std::uint32_t ab = middle(t.a, t.b), bc = middle(t.b, t.c), ca = middle(t.c, t.a);
      finer.insert(finer.end(), {{t.a, ab, ca}, {ab, t.b, bc}, {ca, bc, t.c}, {ab, bc, ca}});
    }
    s.triangles = finer;
  }
  return s;
}

/// Six times the enclosed volume; positive where the triangles face outwards.
inline double six_volumes(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += dot(points[t.a], cross(points[t.b], points[t.c]));
  return sum;
}

}  // namespace nacre::test
