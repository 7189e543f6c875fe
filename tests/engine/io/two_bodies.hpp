// Nacre: the smallest mesh with an interface between two materials, for tests of writers.
#pragma once

#include <string>
#include <vector>

#include "compute/meshing/second_order.hpp"

namespace nacre::test {

/// Of the materials: the outside, 1, 2 (which does not occur) and 3.
inline const std::vector<std::int64_t> body_labels = {0, 5, -7, 300};

/// Two tetrahedra on a common triangle: material 1 above, 3 below; volume 1/6 each.
inline SurfaceMesh two_bodies() {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{1, 2, 3}, {0, 1, 2}, {0, 3, 2}, {0, 1, 3}, {1, 4, 2}, {0, 2, 4}, {0, 4, 1}};
  mesh.materials = {{0, 1}, {1, 3}, {0, 1}, {0, 1}, {0, 3}, {0, 3}, {0, 3}};
  return mesh;
}

inline TetrahedralMesh two_cells() {
  TetrahedralMesh mesh;
  mesh.points = two_bodies().points;
  mesh.cells = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.material = {1, 3};
  return mesh;
}

/// Nodes in the middles of the edges, of the cells or of the triangles alone: those of the edges 01 02 03 04 12 13 14
/// 23 24, in this order.
inline SecondOrder two_bodies_nodes(bool cells) {
  const TetrahedralMesh filled = two_cells();
  return second_order(two_bodies(), cells ? &filled : nullptr,
                      [](std::span<const Vec3d> points, std::span<const Junction>) {
                        return std::vector<Vec3d>(points.begin(), points.end());
                      });
}

}  // namespace nacre::test
