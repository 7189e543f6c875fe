// Nacre: tests of the triangles between labelled cells.
#include "compute/meshing/interfaces.hpp"

#include <gtest/gtest.h>

#include <set>

#include "compute/meshing/topology.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

TEST(Interfaces, OneCellIsClosedByItsFourFacets) {
  const std::vector<Vec3d> points = {{0, 0, 0}, {6, 0, 0}, {9, 9, 9}, {0, 1, 0}, {0, 0, 1}};
  DelaunayCells cells;
  cells.vertices = {{0, 1, 3, 4}};  // leaves out point 2
  cells.neighbours = {{-1, -1, -1, -1}};
  const std::vector<std::uint16_t> label = {3};
  std::vector<std::uint32_t> point_of;
  const SurfaceMesh mesh = extract_interfaces(points, cells, label, &point_of);
  EXPECT_EQ(point_of, (std::vector<std::uint32_t>{0, 1, 3, 4}));
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_TRUE((mesh.triangles[0] == Triangle{1, 2, 3}));  // opposite of the origin, seen from outside
  for (const auto& materials : mesh.materials) EXPECT_EQ(materials, (std::array<std::uint16_t, 2>{0, 3}));
  const TopologyReport report = check_topology(mesh, 4);
  EXPECT_TRUE(report.sound());
  EXPECT_NEAR(report.materials[3].volume, 1, 1e-12);
  EXPECT_TRUE(extract_interfaces(points, cells, std::vector<std::uint16_t>{0}).triangles.empty());
}

TEST(Interfaces, SphereIsClosedAndTurnedOutwards) {
  const std::vector<Vec3d> points = test::points_on_sphere(2000, 5, {1, 2, 3});
  const DelaunayCells cells = delaunay(points);
  const auto label = test::labels_of(cells, [](const Vec3d& p) { return length(p - Vec3d(1, 2, 3)) < 5; });
  const SurfaceMesh mesh = extract_interfaces(points, cells, label);
  const TopologyReport report = check_topology(mesh, 2);
  EXPECT_TRUE(report.sound());
  EXPECT_EQ(report.vertices, 2000);
  EXPECT_EQ(report.triangles, 2 * 2000 - 4);  // Euler
  EXPECT_EQ(report.materials[1].euler, 2);
  EXPECT_EQ(report.components, 1);
  EXPECT_NEAR(report.materials[1].volume, 4. / 3 * std::numbers::pi * 125, 3);
  EXPECT_NEAR(report.materials[0].volume, -report.materials[1].volume, 1e-9);
}

TEST(Interfaces, DoubleBubbleIsConformal) {
  constexpr double d = 0.5;
  const std::vector<Vec3d> points = test::points_on_double_bubble(d, 0.08);
  const DelaunayCells cells = delaunay(points);
  const auto label = test::labels_of(cells, [](const Vec3d& p) { return test::double_bubble_material(d, p); });
  const TopologyReport report = check_topology(extract_interfaces(points, cells, label), 3);
  EXPECT_TRUE(report.sound());
  EXPECT_EQ(report.pinched_edges, 0);
  EXPECT_EQ(report.junction_edges, int(2 * std::numbers::pi * std::sqrt(0.75) / 0.08));  // the circle, once around
  for (const MaterialTopology& m : report.materials) {
    EXPECT_EQ(m.euler, 2);
    EXPECT_TRUE(m.closed);
    EXPECT_EQ(m.components, 1);
  }
  const double cap = std::numbers::pi * (1 - d) * (1 - d) * (2 + d) / 3;  // cut off a ball of radius 1
  EXPECT_NEAR(report.materials[1].volume, 4. / 3 * std::numbers::pi - cap, 0.02);
  EXPECT_NEAR(report.materials[2].volume, report.materials[1].volume, 1e-3);
}

TEST(Interfaces, HullFacetsCloseWhatReachesThem) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 27; ++i) points.push_back({double(i % 3), double(i / 3 % 3), double(i / 9)});
  const DelaunayCells cells = delaunay(points);
  const auto label = test::labels_of(cells, [](const Vec3d& p) { return p.x < 1 ? 1 : 2; });
  const TopologyReport report = check_topology(extract_interfaces(points, cells, label), 3);
  EXPECT_TRUE(report.sound());
  EXPECT_EQ(report.vertices, 27);  // the middle is on the wall between the halves
  EXPECT_EQ(report.junction_edges, 8);
  EXPECT_NEAR(report.materials[1].volume, 4, 1e-12);
  EXPECT_NEAR(report.materials[2].volume, 4, 1e-12);
  EXPECT_NEAR(report.materials[0].volume, -8, 1e-12);
}

}  // namespace
}  // namespace nacre
