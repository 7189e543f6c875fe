// Nacre: tests of the filling of materials with tetrahedra.
#include "compute/meshing/tetrahedra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "compute/device/error.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/repair.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

template <class MaterialAt>
SurfaceMesh surface_between(const std::vector<Vec3d>& points, const MaterialAt& material_at) {
  const DelaunayCells cells = delaunay(points);
  auto label = test::labels_of(cells, material_at);
  repair_labels(points, cells, label);
  return extract_interfaces(points, cells, label);
}

SurfaceMesh ball() {
  return surface_between(test::points_on_sphere(1500, 1), [](const Vec3d& p) { return length(p) < 1; });
}

SurfaceMesh nested_balls() {
  std::vector<Vec3d> points = test::points_on_sphere(1500, 1);
  for (const Vec3d& p : test::points_on_sphere(600, 0.6)) points.push_back(p);
  return surface_between(points, [](const Vec3d& p) { return length(p) > 1 ? 0 : length(p) > 0.6 ? 1 : 2; });
}

using Facet = std::array<std::uint32_t, 3>;
Facet sorted(Facet f) {
  std::sort(f.begin(), f.end());
  return f;
}

/// Facets between cells of two materials, or of one and the outside, must be the triangles of the surface with their
/// materials.
void expect_same_surface(const SurfaceMesh& surface, const TetrahedralMesh& mesh) {
  std::map<Facet, std::vector<std::uint16_t>> sides;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      const auto& c = mesh.cells[i];
      sides[sorted({c[std::size_t((k + 1) % 4)], c[std::size_t((k + 2) % 4)], c[std::size_t((k + 3) % 4)]})].push_back(
          mesh.material[i]);
    }
  std::map<Facet, std::array<std::uint16_t, 2>> found, expected;
  for (auto& [facet, materials] : sides) {
    ASSERT_LE(materials.size(), 2u);
    if (materials.size() == 1) materials.push_back(0);
    if (materials[0] == materials[1]) continue;
    found[facet] = {std::min(materials[0], materials[1]), std::max(materials[0], materials[1])};
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    expected[sorted({t.a, t.b, t.c})] = surface.materials[i];
  }
  EXPECT_TRUE(found == expected) << found.size() << " facets, " << expected.size() << " triangles";
}

void expect_good_filling(const SurfaceMesh& surface, int materials) {
  const TopologyReport topology = check_topology(surface, materials);
  ASSERT_TRUE(topology.sound());
  const TetrahedralMesh mesh = fill_with_tetrahedra(surface);
  ASSERT_GT(mesh.points.size(), surface.points.size());
  EXPECT_TRUE(std::equal(surface.points.begin(), surface.points.end(), mesh.points.begin()));
  expect_same_surface(surface, mesh);
  const CellQuality q = cell_quality(mesh, materials);
  EXPECT_EQ(q.inverted, 0);
  EXPECT_GE(q.share_within_10_160, 0.999);
  EXPECT_EQ(q.volume[0], 0);
  for (int m = 1; m < materials; ++m)
    EXPECT_NEAR(q.volume[std::size_t(m)], topology.materials[std::size_t(m)].volume, 1e-9) << m;
  std::set<std::uint32_t> used;
  for (const auto& cell : mesh.cells) used.insert(cell.begin(), cell.end());
  EXPECT_EQ(used.size(), mesh.points.size());
}

TEST(Tetrahedra, FillABall) { expect_good_filling(ball(), 2); }
TEST(Tetrahedra, FillNestedBalls) { expect_good_filling(nested_balls(), 3); }

TEST(Tetrahedra, FillTwoBodiesThatTouch) {
  expect_good_filling(surface_between(test::points_on_double_bubble(0.5, 0.1),
                                      [](const Vec3d& p) { return test::double_bubble_material(0.5, p); }),
                      3);
}

TEST(Tetrahedra, LeaveAHollowOpen) {  // a shell: within it is the outside
  std::vector<Vec3d> points = test::points_on_sphere(1500, 1);
  for (const Vec3d& p : test::points_on_sphere(600, 0.6)) points.push_back(p);
  expect_good_filling(surface_between(points, [](const Vec3d& p) { return length(p) < 1 && length(p) > 0.6; }), 2);
}

TEST(Tetrahedra, GrowInwardsUnlessToldOtherwise) {
  const SurfaceMesh surface = ball();
  const std::size_t graded = fill_with_tetrahedra(surface).points.size();
  const EdgeLength even = [](std::span<const Vec3d> positions) { return std::vector<float>(positions.size(), 0.09f); };
  const EdgeLength fine_at_right = [](std::span<const Vec3d> positions) {
    std::vector<float> edges;
    for (const Vec3d& p : positions) edges.push_back(p.x > 0 ? 0.09f : 10.0f);
    return edges;
  };
  const TetrahedralMesh dense = fill_with_tetrahedra(surface, even),
                        half = fill_with_tetrahedra(surface, fine_at_right);
  EXPECT_GT(dense.points.size(), graded * 5 / 4);
  EXPECT_GT(half.points.size(), graded);
  EXPECT_LT(half.points.size(), dense.points.size());
  EXPECT_EQ(cell_quality(dense, 2).inverted, 0);
  expect_same_surface(surface, half);
}

TEST(Tetrahedra, AreTheSameEveryTime) {
  const SurfaceMesh surface = nested_balls();
  const TetrahedralMesh first = fill_with_tetrahedra(surface), second = fill_with_tetrahedra(surface);
  EXPECT_TRUE(first.points == second.points);
  EXPECT_TRUE(first.cells == second.cells);
  EXPECT_TRUE(first.material == second.material);
}

TEST(Tetrahedra, RefuseASurfaceThatIsNotClosedOrNotDelaunay) {
  SurfaceMesh open = ball();
  open.triangles.pop_back();
  open.materials.pop_back();
  EXPECT_THROW(fill_with_tetrahedra(open), Error);
  SurfaceMesh foreign = ball();
  foreign.triangles[0] = {0, 700, 1400};
  EXPECT_THROW(fill_with_tetrahedra(foreign), Error);
  EXPECT_THROW(fill_with_tetrahedra({}), Error);
  SurfaceMesh turned = ball();
  std::swap(turned.triangles[5].a, turned.triangles[5].b);
  EXPECT_THROW(fill_with_tetrahedra(turned), Error);
  SurfaceMesh broken = ball();
  broken.triangles[5].a = 5000;
  EXPECT_THROW(fill_with_tetrahedra(broken), Error);
}

TEST(Tetrahedra, StopWhenTold) {
  const std::atomic<bool> stop = true;
  EXPECT_THROW(fill_with_tetrahedra(ball(), {}, &stop), Interrupted);
}

}  // namespace
}  // namespace nacre
