// Nacre: test bodies for the brick octree's cells, against brute force.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/compute/embedding/host_brick_octree.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test::brick_octree_bodies {

/// What is wrong with the cells of an octree.
struct OctreeFaults {
  std::size_t cells = 0, surface_cells = 0;  ///< that should be there
  std::size_t wrong_mask = 0;                ///< stored beyond the radius, or not stored within
  std::size_t wrong_point = 0, wrong_triangle = 0;
  std::size_t wrong_surface = 0;  ///< touched and not a surface cell, or the other way round
  double worst = 0;               ///< error of the point, or of the distance where two points are as near

  void expect_none(const std::string& what) const {
    EXPECT_GT(cells, 0u) << what;
    EXPECT_EQ(wrong_mask, 0u) << what;
    EXPECT_EQ(wrong_point, 0u) << what << ", worst " << worst;
    EXPECT_EQ(wrong_triangle, 0u) << what;
    EXPECT_EQ(wrong_surface, 0u) << what;
  }
};

inline void check_cell(const HostBrickOctree& tree, const BruteForce& brute, double radius, const Int3& cell,
                       BrickOctreeView::Cursor& cursor, OctreeFaults& faults) {
  const Vec3d x = Vec3d(cell) + Vec3d(0.5);
  const CellIndex at = cursor.find(cell);
  const std::uint32_t hint = at == no_cell ? none : tree.point[at].triangle;
  const auto nearest = brute(x, radius + 1e-3, hint);
  const bool inside = nearest.triangle != none && nearest.distance <= radius;
  if (std::fabs(nearest.distance - radius) > 1e-9) faults.wrong_mask += inside != (at != no_cell);
  faults.cells += inside;
  if (inside && at != no_cell) {
    const Vec3d p = tree.closest(cell, at);
    const double error = nearest.unique ? length(p - nearest.point) : std::fabs(length(p - x) - nearest.distance);
    faults.worst = std::max(faults.worst, error);
    faults.wrong_point += error > 1e-5;
    faults.wrong_triangle += hint >= brute.size() || length(reference_closest_point(brute.corners(hint), p) - p) > 1e-5;
  }
  bool touched = false;
  if (nearest.distance < 0.8661)
    for (std::uint32_t t = 0; t < brute.size() && !touched; ++t)
      touched = touches_cube(brute.corners(t), x, 0.5 + 1e-7);
  faults.surface_cells += touched;
  faults.wrong_surface += touched != (cursor.find_surface(cell) != no_cell);
}

/// Looks at all cells of the domain, or at those of first .. last.
inline OctreeFaults find_faults(const HostBrickOctree& tree, const BruteForce& brute, double radius, Int3 first,
                                Int3 last) {
  OctreeFaults faults;
  BrickOctreeView::Cursor cursor(tree.view);
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) check_cell(tree, brute, radius, {x, y, z}, cursor, faults);
  return faults;
}

template <class Backend>
void expect_octree(Executor<Backend>& exec, const Mesh& mesh, int levels, double radius, const std::string& what) {
  const HostBrickOctree tree = brick_octree(exec, mesh, levels, radius);
  const OctreeFaults faults =
      find_faults(tree, BruteForce(mesh.points, mesh.triangles), radius, Int3(0), Int3(tree.view.size() - 1));
  faults.expect_none(what + ", radius " + std::to_string(radius));
  EXPECT_EQ(tree.view.cells, faults.cells) << what;
  EXPECT_EQ(tree.view.surface_cells, faults.surface_cells) << what;
}

template <class Backend>
void RoundAndSquare(Executor<Backend>& exec) {
  for (const double radius : {1.0, 3.3, 5.0}) {
    expect_octree(exec, sphere({15.3, 15.1, 14.8}, 8, 12), 2, radius, "sphere");
    expect_octree(exec, torus({15.3, 15.1, 14.8}, 7, 2.5, 10), 2, radius, "torus");
    expect_octree(exec, box({7, 7, 7}, {20, 18, 16}, 1), 2, radius, "box on cell faces");
  }
  expect_octree(exec, box({8, 8, 8}, {24, 24, 24}, 3), 2, 4.47, "box on brick faces");
  expect_octree(exec, sphere({14.8, 16.2, 15.7}, 2, 60), 2, 7.5, "a fine sphere in a wide band");
}

template <class Backend>
void Soups(Executor<Backend>& exec) {
  expect_octree(exec, soup(40, 6, 26, 6, 21), 2, 4.47, "large triangles");
  expect_octree(exec, soup(600, 6, 20, 0.7, 22), 2, 3.5, "small triangles");
  expect_octree(exec, soup(5000, 12, 16, 0.05, 25), 2, 4, "tiny triangles, hundreds in a cell");
  expect_octree(exec, soup(2500, 8, 17, 0.3, 26), 2, 3, "some in every cell, more than the short lists hold");
  Mesh mixed = soup(300, 6, 20, 0.3, 23);
  mixed.add(soup(10, 6, 20, 7, 24));
  expect_octree(exec, mixed, 2, 4.47, "both");
}

template <class Backend>
void FoldedAndCoincidentSheets(Executor<Backend>& exec) {
  Mesh folded = sheet({7, 7, 12.1}, {12, 0, 0}, {0, 12, 0}, 8);
  folded.add(sheet({7, 7, 12.4}, {12, 0, 0.2}, {0, 12, 0}, 5));
  folded.add(sheet({7, 7, 12.7}, {12, 0, 0}, {0, 12, 0.1}, 1));
  expect_octree(exec, folded, 2, 4.47, "sheets 0.3 cells apart");

  Mesh twice = sheet({6.3, 6.2, 8.1}, {12, 0, 0}, {0, 13, 1}, 3);
  const auto n = std::uint32_t(twice.triangles.size());
  twice.add(Mesh(twice));
  expect_octree(exec, twice, 2, 4.47, "coincident sheets");
  const HostBrickOctree tree = brick_octree(exec, twice, 2, 4.47);
  for (const CellPoint& p : tree.point) ASSERT_LT(p.triangle, n);
}

template <class Backend>
void SliversAndPoints(Executor<Backend>& exec) {
  Random random(25);
  Mesh slivers;
  for (int k = 0; k < 40; ++k) {
    const Vec3d a = random.point(6, 26), b = random.point(6, 26);
    const double thin = k % 4 == 0 ? 0 : k % 4 == 1 ? 1e-12 : k % 4 == 2 ? 1e-8 : 1e-5;
    slivers.add(Corners{a, b, a + (b - a) * random() + random.point(-1, 1) * thin});
  }
  expect_octree(exec, slivers, 2, 4.47, "slivers");
  Mesh point;
  point.add(Corners{{7, 7, 7}, {7, 7, 7}, {7, 7, 7}});
  point.add(Corners{{20.2, 6.5, 9.5}, {20.2, 18.5, 9.5}, {20.2, 18.5, 9.5}});  // an edge along cell centres
  expect_octree(exec, point, 2, 4.47, "a point and an edge");
}

/// Triangles hundreds of cells wide, of which the domain holds a part.
template <class Backend>
void PartlyOutside(Executor<Backend>& exec) {
  Mesh mesh;
  mesh.add(Corners{{-300, -200, 5}, {400, 20, 11}, {30, 600, 9}});
  mesh.add(Corners{{12, 15, -2}, {14, 12, -60}, {9, 11, -3}});
  mesh.add(Corners{{1e6, 2e6, 3e6}, {-1e6, -2e6, -3e6}, {-1e6, -2e6, -3e6 + 1}});
  expect_octree(exec, mesh, 2, 4.47, "partly outside");
}

/// In one brick, and in the corners of the domain.
template <class Backend>
void OneBrick(Executor<Backend>& exec) {
  Mesh mesh;
  mesh.add(Corners{{3.2, 3.1, 3.4}, {4.6, 3.3, 3.2}, {3.9, 4.4, 4.1}});
  expect_octree(exec, mesh, 0, 2.5, "levels 0");
  const HostBrickOctree one = brick_octree(exec, mesh, 0, 2.5);
  EXPECT_EQ(one.view.brick_count, 1u);
  EXPECT_EQ(one.node.size(), 0u);
  EXPECT_EQ(one.view.locate({0, 0, 0}), 0u);
  EXPECT_EQ(one.view.locate({1, 0, 0}), none);
  const HostBrickOctree same = brick_octree(exec, mesh, 3, 2.5);
  EXPECT_EQ(same.view.brick_count, 1u);
  EXPECT_EQ(same.node.size(), 3u);
  Mesh corners;
  for (const double x : {0.01, 31.99}) corners.add(Corners{{x, x, x}, {x, 31.98, x}, {x, x, 0.02}});
  expect_octree(exec, corners, 2, 3, "corners of the domain");
}

NACRE_DEVICE_TEST(BrickOctree, RoundAndSquare)
NACRE_DEVICE_TEST(BrickOctree, Soups)
NACRE_DEVICE_TEST(BrickOctree, FoldedAndCoincidentSheets)
NACRE_DEVICE_TEST(BrickOctree, SliversAndPoints)
NACRE_DEVICE_TEST(BrickOctree, PartlyOutside)
NACRE_DEVICE_TEST(BrickOctree, OneBrick)

}  // namespace nacre::test::brick_octree_bodies
