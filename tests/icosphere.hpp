// Nacre: triangles of even size on the unit sphere, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre::test {

struct Icosphere {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;  ///< outward
};

/// An icosahedron split `levels` times into 20 * 4^levels triangles.
inline Icosphere unit_icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Icosphere s;
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
    s.triangles = std::move(finer);
  }
  return s;
}

}  // namespace nacre::test
