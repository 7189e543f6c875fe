// Nacre: tests of long edges of bad triangles that new points split.
#include "compute/meshing/edge_splits.hpp"

#include <gtest/gtest.h>

#include "compute/meshing/topology.hpp"

namespace nacre::edge_splits_test {
namespace {

constexpr DefectRule rule{0, 0.5, 0.5, false};

/// A closed body whose longest edge, from point 0 to point 1, has two flat triangles.
SurfaceMesh long_body() {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {2, 0.8, 0}, {2, -0.8, 0}, {2, 0, -3}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}};
  mesh.materials.assign(6, {0, 1});
  return mesh;
}

/// The same body in two halves, materials 1 and 2, with a third of the outside above.
SurfaceMesh long_curve() {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {2, 0.8, 0}, {2, -0.8, 0}, {2, 0, -3}};
  // 1 is between the planes through (0, 1, 2) and (0, 1, 4), 2 between those through (0, 1, 3) and (0, 1, 4).
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {0, 1, 4}};
  mesh.materials = {{0, 1}, {0, 2}, {0, 1}, {0, 1}, {0, 2}, {0, 2}, {1, 2}};
  return mesh;
}

std::vector<Vec3d> middles(std::span<const EdgeSplit> splits) {
  std::vector<Vec3d> at;
  for (const EdgeSplit& s : splits) at.push_back(s.point.position);
  return at;
}

TEST(EdgeSplits, ALongEdgeGetsAPointInItsMiddle) {
  SurfaceMesh mesh = long_body();
  ASSERT_TRUE(check_topology(mesh, 2).sound());
  const std::vector<std::uint8_t> order(5, 2);
  const std::vector<float> size(5, 2);
  const double before = fitness(mesh, order, rule);
  ASSERT_LT(before, 1);
  const std::vector<EdgeSplit> splits = edges_to_split(mesh, order, size, rule);
  ASSERT_EQ(splits.size(), 1u) << "the two flat triangles have the same longest edge";
  EXPECT_EQ(splits[0].point.position, Vec3d(2, 0, 0));
  EXPECT_EQ(splits[0].point.third, 0xffff);
  EXPECT_EQ(split_edges(mesh, order, splits, middles(splits), rule), std::vector<std::uint32_t>{0});
  EXPECT_EQ(mesh.points.size(), 6u);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  const TopologyReport topology = check_topology(mesh, 2);
  EXPECT_TRUE(topology.sound());
  EXPECT_NEAR(topology.materials[1].volume, check_topology(long_body(), 2).materials[1].volume, 1e-12);
  EXPECT_GT(fitness(mesh, std::vector<std::uint8_t>(6, 2), rule), before);
}

TEST(EdgeSplits, ACurveIsSplitForAllItsSurfaces) {
  SurfaceMesh mesh = long_curve();
  const std::vector<std::uint8_t> order{1, 1, 2, 2, 1};
  const std::vector<float> size(5, 2);
  const std::vector<EdgeSplit> splits = edges_to_split(mesh, order, size, rule);
  ASSERT_EQ(splits.size(), 1u);
  EXPECT_EQ(splits[0].point.materials, (std::array<std::uint16_t, 2>{0, 1}));
  EXPECT_EQ(splits[0].point.third, 2);
  ASSERT_EQ(split_edges(mesh, order, splits, middles(splits), rule).size(), 1u);
  EXPECT_EQ(mesh.triangles.size(), 10u);
  std::array<int, 3> of_pair{};
  for (const Triangle& t : mesh.triangles)
    if (t.a == 5 || t.b == 5 || t.c == 5) {
      const auto& m = mesh.materials[std::size_t(&t - mesh.triangles.data())];
      ++of_pair[std::size_t(m[0] + m[1] - 1)];
    }
  EXPECT_EQ(of_pair, (std::array<int, 3>{2, 2, 2}));
}

TEST(EdgeSplits, ShortEdgesAndGoodTrianglesStay) {
  const SurfaceMesh mesh = long_body();
  const std::vector<std::uint8_t> order(5, 2);
  EXPECT_TRUE(edges_to_split(mesh, order, std::vector<float>(5, 4), rule).empty()) << "no longer than 1.3 sizes";
  constexpr DefectRule lenient{0, 0.05, 0.05, false};
  EXPECT_TRUE(edges_to_split(mesh, order, std::vector<float>(5, 2), lenient).empty());
}

/// Two bodies that have an edge in common: a point there would belong to both.
TEST(EdgeSplits, AnEdgeWhereTheSurfaceTouchesItselfStays) {
  SurfaceMesh mesh = long_body();
  mesh.points.insert(mesh.points.end(), {{2, 0.8, 1}, {2, -0.8, 1}, {2, 0, 4}});
  for (const Triangle& t : {Triangle{0, 5, 1}, Triangle{0, 1, 6}, Triangle{0, 7, 5}, Triangle{5, 7, 1},
                            Triangle{1, 7, 6}, Triangle{6, 7, 0}})
    mesh.triangles.push_back(t), mesh.materials.push_back({0, 1});
  EXPECT_TRUE(edges_to_split(mesh, std::vector<std::uint8_t>(8, 2), std::vector<float>(8, 2), rule).empty());
}

TEST(EdgeSplits, APointThatSpoilsTrianglesIsNotTaken) {
  SurfaceMesh mesh = long_body();
  const std::vector<std::uint8_t> order(5, 2);
  const std::vector<EdgeSplit> splits = edges_to_split(mesh, order, std::vector<float>(5, 2), rule);
  ASSERT_EQ(splits.size(), 1u);
  for (const Vec3d& at : {Vec3d(0.02, 0, 0), Vec3d(2, 0, -2.9)}) {  // beside an end; through the body
    EXPECT_TRUE(split_edges(mesh, order, splits, std::vector<Vec3d>{at}, rule).empty());
    EXPECT_EQ(mesh.points, long_body().points);
    EXPECT_EQ(mesh.triangles, long_body().triangles);
    EXPECT_EQ(mesh.materials.size(), mesh.triangles.size());
  }
}

}  // namespace
}  // namespace nacre::edge_splits_test
