// Nacre: triangles of even size on a sphere about zero, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre::test {

/// An icosahedron, each of whose triangles is divided into four `level` times; material 1 is inside.
inline SurfaceMesh icosphere(int level, double radius) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  SurfaceMesh mesh;
  mesh.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int k = 0; k < level; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.points.size()));
      if (fresh) {
        const Vec3d p = normalized(mesh.points[a]) + normalized(mesh.points[b]);
        mesh.points.push_back(p);
      }
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t ab = middle(t.a, t.b), bc = middle(t.b, t.c), ca = middle(t.c, t.a);
      finer.insert(finer.end(), {{t.a, ab, ca}, {t.b, bc, ab}, {t.c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3d& p : mesh.points) p = normalized(p) * radius;
  mesh.materials.assign(mesh.triangles.size(), {0, 1});
  return mesh;
}

}  // namespace nacre::test
