// Nacre: tests of implicit surfaces as closed triangle meshes.
#include "engine/scene/samples/polygonise.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numbers>

#include "compute/device/error.hpp"
#include "engine/scene/samples/implicit_shapes.hpp"
#include "engine/scene/samples/weld.hpp"
#include "tests/engine/scene/samples/closed_mesh.hpp"

namespace nacre {
namespace {

constexpr double kPi = std::numbers::pi;

double ball(const Vec3d& p) { return length(p) - 1; }
double ring(const Vec3d& p) { return norm(norm(p.x, p.y) - 1, p.z) - 0.4; }
/// Ten thin rods across a plate: much that is nearly too thin for the mesh.
double comb(const Vec3d& p) {
  double distance = rounded_extrusion(norm(p.x, p.y) - 1, p.z, 0.05, 0.02);
  for (int i = -2; i <= 2; ++i)
    for (const double x : {-0.25, 0.25})
      distance = smooth_union(distance, round_cone(p, {x, 0.2 * i, -0.6}, {x, 0.2 * i, 0.5}, 0.04, 0.03), 0.03);
  return distance;
}

void expect_sound(const MeshCheck& check) {
  EXPECT_EQ(check.open_half_edges, 0u);
  EXPECT_EQ(check.repeated_half_edges, 0u);
  EXPECT_EQ(check.pinched_points, 0u);
  EXPECT_EQ(check.degenerate_triangles, 0u);
}

TEST(Polygonise, BallIsClosedEvenAndExact) {
  const double edge = 0.08;
  const PolygonMesh mesh = polygonise(ball, Vec3d(-1.2), Vec3d(1.2), edge);
  const MeshCheck check = check_mesh(mesh.points, mesh.triangles);
  expect_sound(check);
  EXPECT_EQ(check.euler, 2);
  EXPECT_NEAR(check.volume, 4 * kPi / 3, 0.01 * 4 * kPi / 3);
  EXPECT_GT(check.least_angle, 20);
  EXPECT_NEAR(check.mean_edge, edge, 0.25 * edge);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    ASSERT_LT(std::abs(ball(mesh.points[i])), 1e-9);
    ASSERT_LT(length(mesh.normals[i] - mesh.points[i]), 1e-6);
  }
}

TEST(Polygonise, TorusHasOneHandle) {
  const PolygonMesh mesh = polygonise(ring, {-1.5, -1.5, -0.5}, {1.5, 1.5, 0.5}, 0.07);
  const MeshCheck check = check_mesh(mesh.points, mesh.triangles);
  expect_sound(check);
  EXPECT_EQ(check.euler, 0);
  EXPECT_NEAR(check.volume, 2 * kPi * kPi * 0.16, 0.02 * 2 * kPi * kPi * 0.16);
  EXPECT_GT(check.least_angle, 20);
  for (const Vec3d& p : mesh.points) ASSERT_LT(std::abs(ring(p)), 1e-9);
}

TEST(Polygonise, StaysManifoldWherePartsAreThinnerThanTheMesh) {
  for (const double edge : {0.03, 0.06, 0.11, 0.2}) {
    const PolygonMesh mesh = polygonise(comb, Vec3d(-1.3), Vec3d(1.3), edge);
    SCOPED_TRACE(edge);
    expect_sound(check_mesh(mesh.points, mesh.triangles));
    for (const Vec3d& p : mesh.points) ASSERT_LT(std::abs(comb(p)), 1e-6);
  }
}

TEST(Polygonise, TrianglesFollowTheEdgeLengthQuadratically) {
  const auto count = [](double edge) {
    return double(polygonise(ball, Vec3d(-1.2), Vec3d(1.2), edge).triangles.size());
  };
  EXPECT_NEAR(count(0.05) / count(0.1), 4, 0.4);
}

TEST(Polygonise, SameOnOneThread) {
  const PolygonMesh many = polygonise(ring, {-1.5, -1.5, -0.5}, {1.5, 1.5, 0.5}, 0.1);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const PolygonMesh single = polygonise(ring, {-1.5, -1.5, -0.5}, {1.5, 1.5, 0.5}, 0.1);
  EXPECT_TRUE(many.points == single.points);
  EXPECT_TRUE(many.triangles == single.triangles);
}

TEST(Polygonise, RefusesWhatItCannotClose) {
  EXPECT_THROW(polygonise(ball, Vec3d(-0.9), Vec3d(1.2), 0.1), Error);
  EXPECT_THROW(polygonise(ball, Vec3d(2), Vec3d(3), 0.1), Error);
  EXPECT_THROW(polygonise(ball, Vec3d(-2), Vec3d(2), 0), Error);
  EXPECT_THROW(polygonise(ball, Vec3d(-2), Vec3d(2), 1e-9), Error);
}

TEST(ImplicitShapes, RoundConeIsTheHullOfTwoBalls) {
  // Radii 0.5 and 0.2 at a distance of 1: the hull's normal is (0.3, sqrt(0.91)) between the balls.
  EXPECT_NEAR(round_cone(-1, 0, 1, 0.5, 0.2), 0.5, 1e-12);
  EXPECT_NEAR(round_cone(1.5, 0, 1, 0.5, 0.2), 0.3, 1e-12);
  const double c = std::sqrt(0.91);
  EXPECT_NEAR(round_cone(0.3 * 0.9 + c * 0.4, c * 0.9 - 0.3 * 0.4, 1, 0.5, 0.2), 0.4, 1e-12);
}

TEST(ImplicitShapes, SmoothUnionOnlyAddsNearTheSeam) {
  EXPECT_EQ(smooth_union(0.5, 0.1, 0.2), 0.1);
  EXPECT_NEAR(smooth_union(0.1, 0.1, 0.3), 0.1 - 0.05, 1e-12);
  EXPECT_NEAR(smooth_cut(-0.1, 0.1, 0.3), -0.1 + 0.05, 1e-12);
}

TEST(Weld, NumbersTheDistinctKeys) {
  const Welded welded = weld({{70, 10, 30}, {30, 10, 50}});
  EXPECT_EQ(welded.keys, (std::vector<std::uint64_t>{10, 30, 50, 70}));
  EXPECT_EQ(welded.triangles, (std::vector<Triangle>{{3, 0, 1}, {1, 0, 2}}));
}

}  // namespace
}  // namespace nacre
