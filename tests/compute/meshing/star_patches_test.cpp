// Nacre: what stars leave open is settled by cells, with known materials.
#include "compute/meshing/star_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "tests/compute/meshing/cpu_stars.hpp"

namespace nacre::test {
namespace {

/// The materials of `halves`.
std::vector<std::uint16_t> material_in_halves(double radius, std::span<const Vec3d> points) {
  std::vector<std::uint16_t> material;
  for (const Vec3d& p : points) material.push_back(length(p) > radius ? 0 : p.z > 0 ? 1 : 2);
  return material;
}

struct Settled {
  StarMesh mesh;
  bool sound = false;
  std::vector<std::array<std::uint32_t, 2>> touching;
};

Settled settle(const Cloud& cloud, double radius, const std::vector<std::uint32_t>& more = {}) {
  Settled settled{mesh_of(cloud), false, {}};
  std::vector<std::uint32_t>& unsettled = settled.mesh.unsettled;
  unsettled.insert(unsettled.end(), more.begin(), more.end());
  std::vector<Vec3d> points;
  std::vector<double> size;
  for (const Float4& p : cloud.position) points.push_back({p.x, p.y, p.z}), size.push_back(p.w);
  PatchCells cells;
  const PatchWorld world{points, size, [&](std::span<const Vec3d> at) { return material_in_halves(radius, at); }};
  settled.sound = settle_by_cells(settled.mesh, world, cells, settled.touching);
  return settled;
}

void expect_halves(const Cloud& cloud, const Settled& settled, double radius) {
  ASSERT_TRUE(settled.sound);
  EXPECT_TRUE(settled.mesh.unsettled.empty());
  EXPECT_TRUE(settled.touching.empty());
  const TopologyReport topology = cloud.topology(settled.mesh, 3);
  EXPECT_TRUE(topology.sound());
  for (const std::size_t m : {1, 2}) {
    EXPECT_TRUE(topology.materials[m].closed);
    EXPECT_EQ(topology.materials[m].euler, 2);
    EXPECT_NEAR(topology.materials[m].volume, 2 * M_PI * std::pow(radius, 3) / 3, 12);
  }
}

TEST(StarPatches, WhereAllIsSettledNothingChanges) {
  const Cloud cloud = halves(6, 0.8);
  const StarMesh stars = mesh_of(cloud);
  const Settled settled = settle(cloud, 6);
  expect_halves(cloud, settled, 6);
  EXPECT_EQ(settled.mesh.triangles, stars.triangles);
  EXPECT_EQ(settled.mesh.counts.in_patches, 0);
}

TEST(StarPatches, CellsAndStarsMeetEdgeToEdge) {
  const Cloud cloud = halves(6, 0.8);
  for (const std::uint32_t at : {0U, 60U, 200U, 500U}) {  // on the rim, and away from it
    const Settled settled = settle(cloud, 6, {at});
    expect_halves(cloud, settled, 6);
    EXPECT_GT(settled.mesh.counts.in_patches, 0);
    EXPECT_LT(settled.mesh.counts.in_patches, 20);
  }
}

/// A patch that takes in several materials, and far more than it reaches beyond. Its cells agree with the stars around
/// it, so that it has no reason to grow, however far its own large cells reach.
TEST(StarPatches, AWidePatchStaysAsItIs) {
  const Cloud cloud = halves(12, 0.8);
  for (const double wide : {4.0, 7.0}) {
    std::vector<std::uint32_t> within;
    for (std::uint32_t i = 0; i < cloud.position.size(); ++i) {
      const Float4& p = cloud.position[i];
      if (length(Vec3d(p.x, p.y, p.z) - Vec3d(12, 0, 0)) < wide) within.push_back(i);
    }
    const Settled settled = settle(cloud, 12, within);
    expect_halves(cloud, settled, 12);
    EXPECT_LT(settled.mesh.counts.in_patches, std::int64_t(within.size() * 11 / 10)) << within.size();
  }
}

/// The ball of a cell is empty near the particles whose facets are wanted; farther away it may have others in it, of
/// which the patch knows nothing.
TEST(StarPatches, MaterialsAreLookedUpNearParticles) {
  const Cloud cloud = halves(6, 0.8);
  std::vector<Vec3d> points, asked;
  std::vector<double> size;
  for (const Float4& p : cloud.position) points.push_back({p.x, p.y, p.z}), size.push_back(p.w);
  const PatchWorld world{points, size, [&](std::span<const Vec3d> at) {
                           asked.assign(at.begin(), at.end());
                           return material_in_halves(6, at);
                         }};
  PatchCells cells;
  PatchCells::Points patch;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (length(points[i] - points[200]) < 4) {
      patch.places.push_back(points[i]), patch.size.push_back(size[i]);
      patch.wanted.push_back(length(points[i] - points[200]) < 1);
    }
  const auto delaunay = cells.delaunay();
  const auto made = cells.make({{patch, delaunay.get()}}, world, nullptr).at(0);
  ASSERT_EQ(asked.size(), made->cells.vertices.size());
  std::size_t far = 0;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto& cell = made->cells.vertices[i];
    const auto wanted = std::find_if(cell.begin(), cell.end(), [&](std::uint32_t v) { return patch.wanted[v] != 0; });
    if (wanted == cell.end()) continue;
    const Vec3d& at = patch.places[*wanted];
    EXPECT_LT(length(asked[i] - at), 1.0001 * patch.size[*wanted]);
    far += length(made->cells.circumcentres[i] - at) > 2 * patch.size[*wanted];
  }
  EXPECT_GT(far, 5U);  // of which this is not true by itself
}

/// What is far apart is settled as if each were alone.
TEST(StarPatches, GroupsDoNotDependOnEachOther) {
  const Cloud cloud = halves(9, 0.8);
  const auto triangles = [&](const std::vector<std::uint32_t>& at) {
    const Settled settled = settle(cloud, 9, at);
    expect_halves(cloud, settled, 9);
    std::vector<std::array<std::uint32_t, 3>> sorted;
    for (Triangle t : settled.mesh.triangles) {
      while (t.a > t.b || t.a > t.c) t = {t.b, t.c, t.a};
      sorted.push_back({t.a, t.b, t.c});
    }
    std::sort(sorted.begin(), sorted.end());
    return std::pair(sorted, settled.mesh.counts.in_patches);
  };
  const auto none_at = triangles({}).first;
  const auto first = triangles({0}), second = triangles({900}), both = triangles({0, 900});
  EXPECT_EQ(both.second, first.second + second.second);
  std::vector<std::array<std::uint32_t, 3>> made_first, made_second, made_both, made;
  const auto new_ones = [&](const auto& some, auto& list) {
    std::set_difference(some.begin(), some.end(), none_at.begin(), none_at.end(), std::back_inserter(list));
  };
  new_ones(first.first, made_first), new_ones(second.first, made_second), new_ones(both.first, made_both);
  std::set_union(made_first.begin(), made_first.end(), made_second.begin(), made_second.end(),
                 std::back_inserter(made));
  EXPECT_EQ(made, made_both);
}

TEST(StarPatches, CellsThatAreKeptGiveTheSameMesh) {
  const Cloud cloud = halves(6, 0.8);
  std::vector<Vec3d> points;
  std::vector<double> size;
  for (const Float4& p : cloud.position) points.push_back({p.x, p.y, p.z}), size.push_back(p.w);
  int looked_up = 0;
  const PatchWorld world{points, size, [&](std::span<const Vec3d> at) {
                           ++looked_up;
                           return material_in_halves(6, at);
                         }};
  PatchCells cells;
  std::vector<std::vector<Triangle>> made;
  std::vector<int> asked;
  for (int round = 0; round < 3; ++round) {
    StarMesh mesh = mesh_of(cloud);
    mesh.unsettled = {0, 200, 500};
    std::vector<std::array<std::uint32_t, 2>> touching;
    ASSERT_TRUE(settle_by_cells(mesh, world, cells, touching));
    made.push_back(mesh.triangles), asked.push_back(looked_up);
  }
  EXPECT_GT(asked[0], 0);
  EXPECT_EQ(asked[2], asked[0]);
  EXPECT_EQ(made[1], made[0]);
  EXPECT_EQ(made[2], made[0]);
}

/// Particles that have not moved stay in the patch of the mesh before, though their stars agree again.
TEST(StarPatches, ParticlesStayInThePatchOfTheMeshBefore) {
  Cloud cloud = halves(6, 0.8);
  PatchCells cells;
  std::vector<std::int64_t> in_patches;
  for (int round = 0; round < 3; ++round) {
    std::vector<Vec3d> points;
    std::vector<double> size;
    for (const Float4& p : cloud.position) points.push_back({p.x, p.y, p.z}), size.push_back(p.w);
    const PatchWorld world{points, size, [&](std::span<const Vec3d> at) { return material_in_halves(6, at); }};
    StarMesh mesh = mesh_of(cloud);
    mesh.unsettled = {round == 0 ? 200u : 500u};
    std::vector<std::array<std::uint32_t, 2>> touching;
    ASSERT_TRUE(settle_by_cells(mesh, world, cells, touching));
    in_patches.push_back(mesh.counts.in_patches);
    if (round == 1)
      for (Float4& p : cloud.position) p.w *= 0.999f, p.x += 1e-4f;
  }
  EXPECT_EQ(in_patches, (std::vector<std::int64_t>{1, 2, 1}));
}

/// A rim that lacks particles has no chain around it; the cells close it.
TEST(StarPatches, ABrokenRimIsClosedByCells) {
  Cloud cloud = halves(6, 0.8);
  const int missing = 7;
  cloud.position.erase(cloud.position.begin(), cloud.position.begin() + missing);
  cloud.direction.erase(cloud.direction.begin(), cloud.direction.begin() + missing);
  cloud.junction.erase(cloud.junction.begin(), cloud.junction.begin() + missing);
  cloud.gradient.erase(cloud.gradient.begin(), cloud.gradient.begin() + missing);
  ASSERT_FALSE(mesh_of(cloud).sound());
  const Settled settled = settle(cloud, 6);
  expect_halves(cloud, settled, 6);
  EXPECT_LT(settled.mesh.counts.in_patches, std::int64_t(cloud.position.size() / 3));
}

TEST(StarPatches, WhereTooMuchIsOpenItIsLeftToTheCellsOfAll) {
  const Cloud cloud = halves(9, 0.8);
  ASSERT_GT(cloud.position.size(), 1000U);
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < cloud.position.size(); i += 2) all.push_back(i);
  EXPECT_FALSE(settle(cloud, 9, all).sound);
}

}  // namespace
}  // namespace nacre::test
