// Nacre: test bodies for the tree above the bricks, their neighbours and lists, and for domains that are almost empty.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "tests/compute/embedding/brick_octree_body.hpp"
#include "tests/compute/small_cases.hpp"

namespace nacre::test::brick_octree_bodies {

using Place = std::tuple<int, int, int>;
inline Place position(const Int3& c) { return {c.x, c.y, c.z}; }

inline Mesh tree_mesh() {
  Mesh mesh = sphere({30.3, 29.1, 33.8}, 14, 12);
  mesh.add(soup(12, 6, 58, 9, 27));
  return mesh;
}

template <class Backend>
void NeighboursAndWalksAgreeWithTheCodes(Executor<Backend>& exec) {
  const HostBrickOctree tree = brick_octree(exec, tree_mesh(), 3, 3);
  std::map<Place, std::uint32_t> bricks;
  for (std::uint32_t b = 0; b < tree.view.brick_count; ++b) {
    ASSERT_TRUE(b == 0 || tree.brick_code[b - 1] < tree.brick_code[b]);
    ASSERT_GT(tree.brick[b].band.count(), 0);
    bricks[position(morton_cell(tree.brick_code[b]))] = b;
  }
  auto number = [&](const Int3& p) {
    const auto found = bricks.find(position(p));
    return found == bricks.end() ? none : found->second;
  };
  std::size_t absent = 0;
  for (int z = -1; z <= 8; ++z)
    for (int y = -1; y <= 8; ++y)
      for (int x = -1; x <= 8; ++x) {
        ASSERT_EQ(tree.view.locate({x, y, z}), number({x, y, z}));
        absent += number({x, y, z}) == none;
      }
  EXPECT_GT(absent, 500u);
  for (const auto& [p, b] : bricks)
    for (int k = 0; k < 27; ++k)
      ASSERT_EQ(tree.neighbour[27 * b + std::size_t(k)],
                number(Int3(std::get<0>(p) + k % 3 - 1, std::get<1>(p) + k / 3 % 3 - 1, std::get<2>(p) + k / 9 - 1)));
}

template <class Backend>
void TheTreeHasTheAncestorsAndNoMore(Executor<Backend>& exec) {
  const HostBrickOctree tree = brick_octree(exec, tree_mesh(), 3, 3);
  ASSERT_EQ(tree.level_start.size(), 4u);
  EXPECT_EQ(tree.level_start[0], 0u);
  EXPECT_EQ(tree.level_start[3], tree.node.size());
  std::vector<std::uint64_t> level{0};  // codes of the nodes of a level, found by following the nodes from the root
  for (int l = 0; l < 3; ++l) {
    ASSERT_EQ(tree.level_start[std::size_t(l) + 1] - tree.level_start[std::size_t(l)], level.size());
    std::vector<std::uint64_t> next;
    for (std::size_t k = 0; k < level.size(); ++k) {
      const OctreeNode n = tree.node[tree.level_start[std::size_t(l)] + k];
      ASSERT_EQ(n.first, next.size());
      ASSERT_NE(n.children & 255, 0u);
      for (unsigned c = 0; c < 8; ++c)
        if (n.children >> c & 1) next.push_back(level[k] << 3 | c);
    }
    level = next;
    std::set<std::uint64_t> ancestors;
    for (const std::uint64_t code : tree.brick_code) ancestors.insert(code >> 3 * (2 - l));
    ASSERT_EQ(level, std::vector<std::uint64_t>(ancestors.begin(), ancestors.end()));
  }
  EXPECT_EQ(level, tree.brick_code);
}

/// Every way of looking cells up against a table of the cells that are stored.
template <class Backend>
void CursorsFindWhatIsStored(Executor<Backend>& exec) {
  const HostBrickOctree tree = brick_octree(exec, tree_mesh(), 3, 3);
  std::map<Place, std::pair<CellIndex, CellIndex>> cells;
  CellIndex band = 0, surface = 0;
  for (std::uint32_t b = 0; b < tree.view.brick_count; ++b)
    for (int k = 0; k < 512; ++k) {
      const OctreeBrick& brick = tree.brick[b];
      if (!(brick.band.word[k >> 6] >> (k & 63) & 1)) {
        ASSERT_FALSE(brick.surface.word[k >> 6] >> (k & 63) & 1);
        continue;
      }
      const bool touched = brick.surface.word[k >> 6] >> (k & 63) & 1;
      const Int3 c = morton_cell(tree.brick_code[b]) * Int3(8) + Int3(k & 7, k >> 3 & 7, k >> 6);
      cells[position(c)] = {band++, touched ? surface : no_cell};
      surface += touched;
    }
  ASSERT_EQ(band, tree.view.cells);
  ASSERT_EQ(surface, tree.view.surface_cells);
  auto look = [&](const Int3& c) {
    const auto found = cells.find(position(c));
    return found == cells.end() ? std::pair(no_cell, no_cell) : found->second;
  };
  BrickOctreeView::Cursor walker(tree.view);
  for (int z = -2; z < 66; ++z)
    for (int y = -2; y < 66; ++y)
      for (int x = -2; x < 66; ++x) {
        const Int3 c{x, y, z};
        ASSERT_EQ(walker.find(c), look(c).first);
        ASSERT_EQ(BrickOctreeView::Cursor(tree.view).find(c), look(c).first);
        ASSERT_EQ(walker.find_surface(c), look(c).second);
        CellIndex at[8], at_surface[8];
        const unsigned there = walker.eight(c, at), there_surface = walker.eight_surface(c, at_surface);
        for (int k = 0; k < 8; ++k) {
          const auto expected = look(c + Int3(k & 1, k >> 1 & 1, k >> 2));
          ASSERT_EQ(there >> k & 1, expected.first != no_cell);
          ASSERT_EQ(there_surface >> k & 1, expected.second != no_cell);
          ASSERT_TRUE(!(there >> k & 1) || at[k] == expected.first);
          ASSERT_TRUE(!(there_surface >> k & 1) || at_surface[k] == expected.second);
        }
        if ((x + y + z) % 3) continue;
        CellIndex around[27];
        std::fill(around, around + 27, no_cell);
        walker.each_surface_of_27(c, [&](int k, CellIndex number) { around[k] = number; });
        for (int k = 0; k < 27; ++k)
          ASSERT_EQ(around[k], look(c + Int3(k % 3, k / 3 % 3, k / 9)).second) << x << ' ' << y << ' ' << z;
      }
}

template <class Backend>
void ListsHoldTheTrianglesThatTouchABrick(Executor<Backend>& exec) {
  const Mesh mesh = tree_mesh();
  const HostBrickOctree tree = brick_octree(exec, mesh, 3, 3);
  std::size_t total = 0;
  for (std::uint32_t b = 0; b < tree.view.brick_count; ++b) {
    const Vec3d centre = Vec3d(morton_cell(tree.brick_code[b])) + Vec3d(0.5);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if (touches_cube(mesh.corners(t) * 0.125, centre, 0.5 + 1e-7)) expected.push_back(t);
    ASSERT_EQ(std::vector<std::uint32_t>(tree.list.begin() + std::int64_t(tree.list_start[b]),
                                         tree.list.begin() + std::int64_t(tree.list_start[b + 1])),
              expected);
    total += expected.size();
  }
  EXPECT_EQ(total, tree.list.size());
  EXPECT_GT(total, mesh.triangles.size());
}

/// A domain of 2^20 cells per axis with little in it, far apart, and a needle through all of it.
template <class Backend>
void AlmostEmptyDomains(Executor<Backend>& exec) {
  const double far = (1 << 20) - 30.4;
  Mesh mesh = sphere({20.3, 21.1, 19.7}, 5, 8);
  mesh.add(sphere({far, far, far - 5}, 5, 8));
  const HostBrickOctree tree = brick_octree(exec, mesh, 17, 4.47);
  EXPECT_LT(tree.view.brick_count, 200u);
  EXPECT_LT(tree.node.size(), 200u + 34u);
  const BruteForce brute(mesh.points, mesh.triangles);
  OctreeFaults near = find_faults(tree, brute, 4.47, Int3(8), Int3(32));
  near.expect_none("near the origin");
  const int low = (1 << 20) - 48;
  OctreeFaults away = find_faults(tree, brute, 4.47, Int3(low, low, low - 4), Int3(low + 30));
  away.expect_none("at the far end");
  EXPECT_EQ(tree.view.cells, near.cells + away.cells);

  Mesh needle;
  needle.add(Corners{{9, 8, 7}, {16000, 16010, 16020}, {16000, 16010, 16020}});
  const HostBrickOctree thread = brick_octree(exec, needle, 11, 1.5);
  const double length_in_cells = length(needle.points[1] - needle.points[0]);
  EXPECT_NEAR(double(thread.view.cells), length_in_cells * pi * 1.5 * 1.5, 0.02 * double(thread.view.cells));
}

/// A hundred thousand triangles (ten thousand where cases are small) that have nothing to do with each other.
template <class Backend>
void StrayComponents(Executor<Backend>& exec) {
  const int triangles = small_cases() ? 10000 : 100000;
  const Mesh mesh = soup(triangles, 4, 1020, 0.4, 28);
  const HostBrickOctree tree = brick_octree(exec, mesh, 7, 1.5);
  EXPECT_GT(tree.view.cells, 10u * triangles);
  EXPECT_GE(tree.view.brick_count, 8u * triangles / 10);
  const BruteForce brute(mesh.points, mesh.triangles);
  OctreeFaults faults;
  BrickOctreeView::Cursor cursor(tree.view);
  Random random(29);
  for (int k = 0; k < 300; ++k) {
    const Vec3d p = mesh.points[std::size_t(random() * double(mesh.points.size()))] + random.point(-1.2, 1.2);
    check_cell(tree, brute, 1.5, Int3(p), cursor, faults);
  }
  EXPECT_GT(faults.surface_cells, 30u);
  faults.expect_none("stray triangles");
}

NACRE_DEVICE_TEST(BrickOctree, NeighboursAndWalksAgreeWithTheCodes)
NACRE_DEVICE_TEST(BrickOctree, TheTreeHasTheAncestorsAndNoMore)
NACRE_DEVICE_TEST(BrickOctree, CursorsFindWhatIsStored)
NACRE_DEVICE_TEST(BrickOctree, ListsHoldTheTrianglesThatTouchABrick)
NACRE_DEVICE_TEST(BrickOctree, AlmostEmptyDomains)
NACRE_DEVICE_TEST(BrickOctree, StrayComponents)

}  // namespace nacre::test::brick_octree_bodies
