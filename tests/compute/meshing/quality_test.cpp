// Nacre: tests of the measures of shape.
#include "compute/meshing/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace nacre {
namespace {

TEST(Quality, RadiusRatioOfKnownTriangles) {
  EXPECT_NEAR(radius_ratio({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}), 1, 1e-15);
  EXPECT_NEAR(radius_ratio({0, 0, 0}, {3, 0, 0}, {0, 4, 0}), 2 * 1 / 2.5, 1e-15);  // r_in = 1, r_circ = 2.5
  EXPECT_NEAR(radius_ratio({5, 5, 5}, {5, 5, 6}, {5, 6, 5}), 2 * (std::sqrt(2.) - 1), 1e-15);
  EXPECT_EQ(radius_ratio({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0);
  EXPECT_EQ(radius_ratio({1, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0);
  EXPECT_EQ(radius_ratio({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0);
  // A needle of height e on a base of 2: area e, edges 2, 1, 1, so 4 (2 e)^2 / (4 * 2) = 2 e^2.
  for (const double e : {1e-5, 1e-8})
    EXPECT_NEAR(radius_ratio({0, 0, 0}, {2, 0, 0}, {1, e, 0}) / (2 * e * e), 1, 1e-6) << e;
}

TEST(Quality, AnglesOfKnownTriangles) {
  const auto right = triangle_angles({0, 0, 0}, {1, 0, 0}, {0, std::sqrt(3.), 0});
  EXPECT_NEAR(right[0], 90, 1e-12);
  EXPECT_NEAR(right[1], 60, 1e-12);
  EXPECT_NEAR(right[2], 30, 1e-12);
  const auto flat = triangle_angles({0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0});
  EXPECT_NEAR(flat[2], 180, 1e-6);
  EXPECT_NEAR(flat[0] + flat[1] + flat[2], 180, 1e-6);
  EXPECT_EQ(triangle_angles({1, 0, 0}, {1, 0, 0}, {2, 0, 0})[0], 0);
}

TEST(Quality, DihedralAnglesOfKnownCells) {
  const double regular = std::acos(1. / 3) * 180 / std::numbers::pi;
  for (const double angle : dihedral_angles({Vec3d(1, 1, 1), Vec3d(1, -1, -1), Vec3d(-1, 1, -1), Vec3d(-1, -1, 1)}))
    EXPECT_NEAR(angle, regular, 1e-12);
  const auto corner = dihedral_angles({Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)});
  for (int e = 0; e < 3; ++e) EXPECT_NEAR(corner[e], 90, 1e-12);  // at the origin
  for (int e = 3; e < 6; ++e) EXPECT_NEAR(corner[e], std::acos(1 / std::sqrt(3.)) * 180 / std::numbers::pi, 1e-12);
}

TEST(Quality, SurfaceSumsUpAndLooksAwayFromJunctions) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0},  {1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {0, 4, 0}, {3, 0, 0}, {9, 9, 9},
                 {10, 9, 9}, {9, 10, 9}};
  mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {5, 6, 7}};
  mesh.materials = {{0, 1}, {1, 2}, {0, 1}};  // three materials at point 0
  EXPECT_EQ(junction_points(mesh), (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0}));
  const SurfaceQuality q = surface_quality(mesh);
  EXPECT_EQ(q.all.triangles, 3);
  const double isosceles = 2 * (std::sqrt(2.) - 1);
  EXPECT_NEAR(q.all.radius_ratio_mean, (1 + 0.8 + isosceles) / 3, 1e-12);
  EXPECT_NEAR(q.all.radius_ratio_min, 0.8, 1e-12);
  EXPECT_EQ(q.all.radius_ratio_histogram[49], 1);
  EXPECT_EQ(q.all.radius_ratio_histogram[41], 1);
  EXPECT_EQ(std::accumulate(q.all.radius_ratio_histogram.begin(), q.all.radius_ratio_histogram.end(), 0), 3);
  const double smallest = std::atan(0.75) * 180 / std::numbers::pi;  // 3-4-5
  EXPECT_NEAR(q.all.angle_min, smallest, 1e-12);
  EXPECT_NEAR(q.all.angle_max, 90, 1e-12);
  EXPECT_NEAR(q.all.angle_mean_min, (60 + smallest + 45) / 3, 1e-12);
  EXPECT_EQ(q.all.share_under_25, 0);
  EXPECT_EQ(q.away_from_junctions.triangles, 1);
  EXPECT_NEAR(q.away_from_junctions.radius_ratio_min, isosceles, 1e-12);

  mesh.points[7] = {9, 9.1, 9};
  EXPECT_NEAR(surface_quality(mesh).all.share_under_25, 1. / 3, 1e-12);
  EXPECT_EQ(surface_quality({}).all.triangles, 0);
  EXPECT_EQ(surface_quality({}).all.radius_ratio_min, 0);
}

TEST(Quality, CellsSumUp) {
  TetrahedralMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.3, 0.3, -0.01}};
  mesh.cells = {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 4}};
  mesh.material = {1, 2, 2};
  const CellQuality q = cell_quality(mesh, 3);
  EXPECT_EQ(q.cells, 3);
  EXPECT_EQ(q.inverted, 1);
  EXPECT_NEAR(q.volume[1], 1. / 6, 1e-15);
  EXPECT_NEAR(q.volume[2], 0, 1e-15);
  EXPECT_NEAR(q.share_within_10_160, 1. / 3, 1e-15);
  EXPECT_LT(q.dihedral_min, 3);
  EXPECT_GT(q.dihedral_max, 170);
  EXPECT_EQ(std::accumulate(q.dihedral_histogram.begin(), q.dihedral_histogram.end(), 0), 18);
  EXPECT_EQ(q.dihedral_histogram[5], 3);  // 54.7 degrees, three times
  EXPECT_EQ(cell_quality({}, 2).dihedral_min, 0);
}

}  // namespace
}  // namespace nacre
