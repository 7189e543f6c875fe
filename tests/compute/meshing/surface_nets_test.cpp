// Nacre: tests of the quick mesh of labelled voxels.
#include "compute/meshing/surface_nets.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "compute/device/error.hpp"
#include "compute/meshing/topology.hpp"

namespace nacre::surface_nets_test {
namespace {

using Materials = std::vector<std::uint16_t>;

template <class Of>
Materials fill(const Int3& dims, const Of& material_of) {
  Materials voxels;
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x) voxels.push_back(material_of(Vec3d(x, y, z)));
  return voxels;
}

/// A ball of two halves, materials 1 and 2, in voxels of 32^3.
constexpr Int3 ball_dims(32, 32, 32);
constexpr double radius = 12.3;
Materials two_halves() {
  return fill(ball_dims, [](const Vec3d& p) {
    const Vec3d d = p - Vec3d(15.6, 15.3, 16.1);
    return std::uint16_t(dot(d, d) > radius * radius ? 0 : d.x < 0 ? 1 : 2);
  });
}

TEST(SurfaceNets, OneVoxelIsClosedAndTurnedOutwards) {
  const Materials one{5};
  const SurfaceMesh mesh = surface_nets({Int3(1, 1, 1), one, Vec3d(10, 0, 0)}, {.smoothing = 0});
  EXPECT_EQ(mesh.points.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  for (const auto& pair : mesh.materials) EXPECT_EQ(pair, (std::array<std::uint16_t, 2>{0, 5}));
  const TopologyReport report = check_topology(mesh, 6);
  EXPECT_TRUE(report.sound());
  EXPECT_NEAR(report.materials[5].volume, 1, 1e-6);  // a voxel's, and not minus that
  for (const Vec3d& p : mesh.points) EXPECT_NEAR(std::fabs(p.x - 10), 0.5, 1e-6);
}

/// Of a ball as large as both halves together, voxels.
double mean_radius(const TopologyReport& report) {
  return std::cbrt((report.materials[1].volume + report.materials[2].volume) / (4.0 / 3 * std::numbers::pi));
}

TEST(SurfaceNets, HalvesOfABallMeetInOneSheet) {
  const Materials voxels = two_halves();
  const SurfaceMesh mesh = surface_nets({ball_dims, voxels});
  const TopologyReport report = check_topology(mesh, 3);
  EXPECT_TRUE(report.sound());
  EXPECT_GT(report.junction_edges, 0);
  EXPECT_EQ(report.components, 1);
  EXPECT_NEAR(mean_radius(report), radius, 0.25);  // smoothing takes something away
  for (const int m : {1, 2}) {
    EXPECT_TRUE(report.materials[std::size_t(m)].closed);
    EXPECT_EQ(report.materials[std::size_t(m)].euler, 2);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {  // the sheet between them is flat, to its rim
    if (mesh.materials[t] != std::array<std::uint16_t, 2>{1, 2}) continue;
    for (const std::uint32_t v : {mesh.triangles[t].a, mesh.triangles[t].b, mesh.triangles[t].c})
      EXPECT_NEAR(mesh.points[v].x, 15.5, 0.25);
  }
}

/// Root of the mean square of the vertices' distances from the sphere.
double roughness(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const Vec3d& p : mesh.points) sum += std::pow(length(p - Vec3d(15.6, 15.3, 16.1)) - radius, 2);
  return std::sqrt(sum / double(mesh.points.size()));
}

TEST(SurfaceNets, SmoothingFlattensTheStairsButKeepsVerticesInTheirCells) {
  Materials voxels = two_halves();
  for (std::uint16_t& material : voxels) material = std::min<std::uint16_t>(material, 1);
  const SurfaceMesh stairs = surface_nets({ball_dims, voxels}, {.smoothing = 0});
  const SurfaceMesh smooth = surface_nets({ball_dims, voxels});
  EXPECT_LT(roughness(smooth), 0.6 * roughness(stairs));
  ASSERT_EQ(stairs.points.size(), smooth.points.size());
  for (std::size_t v = 0; v < stairs.points.size(); ++v)
    for (int a = 0; a < 3; ++a) EXPECT_LE(std::fabs(smooth.points[v][a] - stairs.points[v][a]), 0.5);
}

TEST(SurfaceNets, TheVolumesPlaceAndItsHandCount) {
  Materials voxels = two_halves();
  const std::array<Vec3d, 3> mirrored{Vec3d(0, 2, 0), Vec3d(3, 0, 0), Vec3d(0, 0, 0.5)};
  const TopologyReport report = check_topology(surface_nets({ball_dims, voxels, Vec3d(1, 1, 1), mirrored}), 3);
  const TopologyReport plain = check_topology(surface_nets({ball_dims, voxels}), 3);
  EXPECT_TRUE(report.sound());
  EXPECT_NEAR(report.materials[2].volume, 3 * plain.materials[2].volume, 1e-3 * plain.materials[2].volume);
}

TEST(SurfaceNets, AStrideTakesFewerVoxelsOfTheSameBody) {
  const Materials voxels = two_halves();
  const SurfaceMesh coarse = surface_nets({ball_dims, voxels}, {.stride = 2}), fine = surface_nets({ball_dims, voxels});
  EXPECT_LT(3 * coarse.triangles.size(), fine.triangles.size());
  const TopologyReport report = check_topology(coarse, 3);
  EXPECT_TRUE(report.materials[1].closed && report.materials[2].closed);
  EXPECT_NEAR(mean_radius(report), radius, 0.8);
  EXPECT_EQ(surface_nets_stride(Int3(512, 512, 512), std::size_t(1) << 24), 2);
  EXPECT_EQ(surface_nets_stride(Int3(512, 512, 512), std::size_t(1) << 27), 1);
}

TEST(SurfaceNets, VoxelsAtTheBorderAreClosedThereAndNothingGivesNothing) {
  const Int3 dims(3, 4, 5);
  const TopologyReport report = check_topology(surface_nets({dims, Materials(60, 1)}, {.smoothing = 0}), 2);
  EXPECT_TRUE(report.sound());
  EXPECT_NEAR(report.materials[1].volume, 60, 1e-4);
  EXPECT_TRUE(surface_nets({dims, Materials(60, 0)}).triangles.empty());
}

TEST(SurfaceNets, TheSameOnAnyNumberOfThreads) {
  const Materials voxels = two_halves();
  const auto made = [&](std::size_t threads) {
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return surface_nets({ball_dims, voxels});
  };
  const SurfaceMesh one = made(1), four = made(4);
  EXPECT_EQ(one.points, four.points);
  EXPECT_EQ(one.triangles, four.triangles);
  EXPECT_EQ(one.materials, four.materials);
}

TEST(SurfaceNets, CanBeStopped) {
  const Materials voxels = two_halves();
  const std::atomic<bool> stop{true};
  EXPECT_THROW(surface_nets({ball_dims, voxels}, {.stop = &stop}), Interrupted);
}

}  // namespace
}  // namespace nacre::surface_nets_test
