// Nacre: tests of edges that are flipped and contracted at bad triangles.
#include "compute/meshing/edge_edits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/repair.hpp"
#include "compute/meshing/surface_nets.hpp"
#include "compute/meshing/topology.hpp"

namespace nacre::edge_edits_test {
namespace {

constexpr DefectRule rule{0, 0.31, 0.21, false};

/// 2 for points within a surface, 1 for those on a curve of three materials, 0 where more meet.
std::vector<std::uint8_t> orders(const SurfaceMesh& mesh) {
  std::vector<std::vector<std::uint16_t>> materials(mesh.points.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const std::uint16_t m : mesh.materials[t]) {
        auto& list = materials[mesh.triangles[t][k]];
        if (std::find(list.begin(), list.end(), m) == list.end()) list.push_back(m);
      }
  std::vector<std::uint8_t> order;
  for (const auto& list : materials) order.push_back(list.size() == 2 ? 2 : list.size() == 3 ? 1 : 0);
  return order;
}

/// A ball of two materials whose points are moved at random by up to `share` of a voxel.
SurfaceMesh shaken_halves(unsigned seed, double share) {
  constexpr int n = 20;
  std::vector<std::uint16_t> voxels;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Vec3d d = Vec3d(x, y, z) - Vec3d(9.6, 9.3, 9.1);
        voxels.push_back(std::uint16_t(dot(d, d) > 55 ? 0 : d.x < 0 ? 1 : 2));
      }
  SurfaceMesh mesh = surface_nets({Int3(n), voxels});
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> shake(-share, share);
  for (Vec3d& p : mesh.points) p += Vec3d(shake(generator), shake(generator), shake(generator));
  return mesh;
}

std::int64_t bad_triangles(const SurfaceMesh& mesh, std::span<const std::uint8_t> order) {
  std::int64_t bad = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) bad += triangle_fitness(mesh, t, order, rule) < 1;
  return bad;
}

TEST(EdgeEdits, TrianglesBecomeBetterAndTopologyStays) {
  std::int64_t before = 0, after = 0;
  EdgeEdits all;
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    SurfaceMesh mesh = shaken_halves(seed, 0.3);
    std::vector<std::uint8_t> order = orders(mesh);
    const std::vector<Vec3d> points = mesh.points;
    const TopologyReport was = check_topology(mesh, 3);
    ASSERT_TRUE(was.sound());
    before += bad_triangles(mesh, order);
    const double fitness_before = fitness(mesh, order, rule);
    const EdgeEdits edits = edit_edges(mesh, order, rule);
    all.flips += edits.flips, all.contractions += edits.contractions;
    ASSERT_EQ(edits.kept.size(), mesh.points.size());
    EXPECT_EQ(std::int64_t(points.size() - mesh.points.size()), edits.contractions);
    std::vector<std::uint8_t> order_left;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      ASSERT_EQ(mesh.points[v], points[edits.kept[v]]);
      order_left.push_back(order[edits.kept[v]]);
    }
    const TopologyReport is = check_topology(mesh, 3);
    EXPECT_TRUE(is.sound());
    EXPECT_EQ(is.unused_points, 0);
    EXPECT_EQ(is.components, was.components);
    for (const std::size_t m : {0, 1, 2}) {
      EXPECT_EQ(is.materials[m].euler, was.materials[m].euler) << m;
      EXPECT_EQ(is.materials[m].components, was.materials[m].components) << m;
      EXPECT_NEAR(is.materials[m].volume, was.materials[m].volume, 0.02 * std::abs(was.materials[m].volume)) << m;
    }
    EXPECT_GE(fitness(mesh, order_left, rule), fitness_before);
    after += bad_triangles(mesh, order_left);
  }
  EXPECT_GT(all.flips, 100);
  EXPECT_GT(all.contractions, 100);
  EXPECT_LT(20 * after, before);
}

TEST(EdgeEdits, AGoodMeshStaysAsItIs) {
  SurfaceMesh mesh = shaken_halves(0, 0);
  const std::vector<std::uint8_t> order = orders(mesh);
  const SurfaceMesh before = mesh;
  constexpr DefectRule lenient{0, 0.02, 0.02, false};
  ASSERT_GE(fitness(mesh, order, lenient), 1);
  const EdgeEdits edits = edit_edges(mesh, order, lenient);
  EXPECT_EQ(edits.flips + edits.contractions, 0);
  EXPECT_EQ(mesh.triangles, before.triangles);
  EXPECT_EQ(mesh.points, before.points);
}

/// Random points in a cube, their Delaunay cells of three materials in layers, ragged as cells are; closed, since cells
/// at the hull are outside.
SurfaceMesh ragged_layers(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> within(0, 10);
  std::vector<Vec3d> points;
  for (int i = 0; i < 250; ++i) points.push_back({within(generator), within(generator), within(generator)});
  const DelaunayCells cells = delaunay(points, 1);
  std::vector<std::uint16_t> label;
  for (const auto& v : cells.vertices) {
    Vec3d middle{};
    for (const std::uint32_t i : v) middle += points[i] / 4;
    const Vec3d d = middle - Vec3d(5, 5, 5);
    label.push_back(std::uint16_t(dot(d, d) > 14 ? 0 : middle.z < 4.7 ? 1 : middle.z < 5.6 ? 2 : 3));
  }
  repair_labels(points, cells, label);
  return extract_interfaces(points, cells, label);
}

/// Among such triangles are many whose edge cannot be flipped since the mesh has the new one: folds of flat
/// tetrahedra, which go from one material to another.
TEST(EdgeEdits, FoldsGoAndTheMeshStaysSound) {
  std::int64_t meshes = 0, before = 0, after = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    SurfaceMesh mesh = ragged_layers(seed);
    const TopologyReport was = check_topology(mesh, 4);
    if (!was.sound()) continue;
    ++meshes;
    const std::vector<std::uint8_t> order = orders(mesh);
    before += bad_triangles(mesh, order);
    const EdgeEdits edits = edit_edges(mesh, order, rule);
    std::vector<std::uint8_t> order_left;
    for (const std::uint32_t v : edits.kept) order_left.push_back(order[v]);
    after += bad_triangles(mesh, order_left);
    const TopologyReport is = check_topology(mesh, 4);
    EXPECT_TRUE(is.sound());
    EXPECT_EQ(is.unused_points, 0);
    for (std::size_t m = 0; m < 4; ++m) EXPECT_EQ(is.materials[m].closed, was.materials[m].closed);
  }
  EXPECT_GT(meshes, 100);
  EXPECT_LT(10 * after, 9 * before) << after << " of " << before;
}

constexpr DefectRule flat{0, 0.2, 0.2, false};

/// Two triangles that their common side makes flat get the other diagonal.
TEST(EdgeEdits, ADiagonalIsFlipped) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {2, 0.3, 0}, {2, -0.3, 0}, {2, 0, -3}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}};
  mesh.materials.assign(6, {0, 1});
  ASSERT_TRUE(check_topology(mesh, 2).sound());
  const EdgeEdits edits = edit_edges(mesh, std::vector<std::uint8_t>(5, 0), flat);  // no point may leave
  EXPECT_EQ(edits.flips, 1);
  EXPECT_TRUE(check_topology(mesh, 2).sound());
}

/// ... but not where the mesh has it.
TEST(EdgeEdits, AFlatTetrahedronStaysAsItIs) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {2, 0.3, 0}, {2, -0.3, 0.2}};
  mesh.triangles = {{0, 2, 1}, {1, 3, 0}, {0, 3, 2}, {1, 2, 3}};
  mesh.materials.assign(4, {0, 1});
  ASSERT_TRUE(check_topology(mesh, 2).sound());
  const SurfaceMesh before = mesh;
  const EdgeEdits edits = edit_edges(mesh, std::vector<std::uint8_t>(4, 2), flat);
  EXPECT_EQ(edits.flips + edits.contractions, 0);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

}  // namespace
}  // namespace nacre::edge_edits_test
