// Nacre: sizes from an image on another grid than the volume's.
#include "compute/pipeline/size_wishes.hpp"

#include <gtest/gtest.h>

#include "compute/device/cpu_device.hpp"
#include "compute/device/error.hpp"
#include "compute/pipeline/volume_frame.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre {
namespace {

/// A ball of 10 voxels of 2 mm around (30, 40, 50) mm, in a volume whose axes are turned.
MeshVolume turned_ball() {
  MeshVolume volume = test::scalar_volume({27, 27, 27}, test::ball({13, 13, 13}, 10));
  volume.spacing = {2, 2, 2};
  volume.axes = {Vec3d(0, 1, 0), Vec3d(-1, 0, 0), Vec3d(0, 0, 1)};
  volume.origin = Vec3d(30, 40, 50) + Vec3d(26, -26, -26);
  return volume;
}

/// Another grid, of 9 x 12 x 7 mm, along the world's axes: `size` (mm) at the place of each voxel.
SizeImage image_of(const test::PlaceFunction& size) {
  SizeImage image;
  image.dims = {9, 8, 10};
  image.spacing = {9, 12, 7};
  image.origin = Vec3d(30, 40, 50) - Vec3d(36, 42, 31.5);
  test::for_each_voxel(image.dims, [&](std::size_t, const Vec3d& v) {
    image.size.push_back(float(size(index_to_world(v, image.origin, image.spacing, image.axes))));
  });
  return image;
}

double mean_edge_where(const SurfaceMesh& mesh, const std::function<bool(const Vec3d&)>& where) {
  double sum = 0;
  int count = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3d &a = mesh.points[t[k]], &b = mesh.points[t[(k + 1) % 3]];
      if (where((a + b) * 0.5)) sum += length(a - b), ++count;
    }
  return count ? sum / count : 0;
}

TEST(SizeWishes, HoldInTheImagesOwnFrameAndNowhereElse) {
  MeshVolume volume = turned_ball();
  volume.sizes = image_of([](const Vec3d& p) { return p.x < 30 ? 2.4 : 0.0; });
  MeshParameters parameters;
  parameters.max_size = 3, parameters.epsilon = 1;
  const auto device = make_cpu_device();
  const SurfaceMesh mesh = test::run_mesh(*device, volume, parameters).mesh;
  const auto low = [](const Vec3d& p) { return p.x < 22; };
  const auto high = [](const Vec3d& p) { return p.x > 40; };
  EXPECT_NEAR(mean_edge_where(mesh, low), 2.4, 0.45);
  volume.sizes.reset();
  const double free = mean_edge_where(test::run_mesh(*device, volume, parameters).mesh, high);
  EXPECT_NEAR(mean_edge_where(mesh, high), free, 0.25 * free) << "no wish there";
  EXPECT_GT(free, 4.5);
}

TEST(SizeWishes, MayBeLargerThanTheLargestSizeAndGiveWayToASmallerBound) {
  MeshVolume volume = turned_ball();
  volume.sizes = image_of([](const Vec3d&) { return 6.0; });
  MeshParameters parameters;
  parameters.epsilon = 1;
  const auto device = make_cpu_device();
  const auto all = [](const Vec3d&) { return true; };
  EXPECT_NEAR(mean_edge_where(test::run_mesh(*device, volume, parameters).mesh, all), 6, 0.8);
  parameters.sizes = "1:1.5";
  EXPECT_NEAR(mean_edge_where(test::run_mesh(*device, volume, parameters).mesh, all), 3, 0.4);
}

TEST(SizeWishes, BetweenVoxelsOnlyThoseWithAWishCount) {
  MeshVolume volume = turned_ball();
  volume.sizes = image_of([](const Vec3d& p) { return p.x < 30 ? 3.0 : p.x < 40 ? 0.0 : 5.0; });
  const SizeWishes wishes = size_wishes(volume);
  EXPECT_FLOAT_EQ(wishes.least, 1.5f) << "in voxels of 2 mm";
  EXPECT_FLOAT_EQ(wishes.most, 2.5f);
  volume.sizes = image_of([](const Vec3d& p) { return p.x < 26 ? 2 + 0.1 * p.x : 0; });
  const SizeWishes slope = size_wishes(volume);
  const SizeWishesView rising{slope.dims, slope.origin, {slope.row[0], slope.row[1], slope.row[2]}, slope.size.data()};
  EXPECT_NEAR(rising(Vec3f(VolumeFrame(volume).to_voxels({15, 41, 52}))), 3.5 / 2, 1e-3) << "linear";
  const SizeWishesView view{
      wishes.dims, wishes.origin, {wishes.row[0], wishes.row[1], wishes.row[2]}, wishes.size.data()};
  const VolumeFrame frame(volume);
  const auto at = [&](const Vec3d& world) { return view(Vec3f(frame.to_voxels(world))); };
  EXPECT_NEAR(at({21, 40, 50}), 1.5, 1e-4);
  EXPECT_NEAR(at({25, 40, 50}), 1.5, 1e-4) << "the next voxel, at 30, has no wish";
  EXPECT_NEAR(at({26, 40, 50}), 0, 1e-4) << "it is the nearest";
  EXPECT_NEAR(at({43, 40, 50}), 0, 1e-4);
  EXPECT_NEAR(at({44, 40, 50}), 2.5, 1e-4);
  EXPECT_NEAR(at({-100, 40, 50}), 0, 1e-6) << "beside the image";
}

TEST(SizeWishes, WhatMakesNoSenseIsRefused) {
  MeshVolume volume = turned_ball();
  const auto refusal = [&](const SizeImage& image) -> std::string {
    volume.sizes = image;
    try {
      size_wishes(volume);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(image_of([](const Vec3d&) { return 0.0; })).find("asks for nothing"), std::string::npos);
  SizeImage elsewhere = image_of([](const Vec3d&) { return 2.0; });
  elsewhere.origin += Vec3d(500, 0, 0);
  EXPECT_NE(refusal(elsewhere).find("within the volume"), std::string::npos);
  EXPECT_NE(refusal(image_of([](const Vec3d&) { return 0.01; })).find("twentieth of a voxel"), std::string::npos);
  EXPECT_EQ(refusal(image_of([](const Vec3d&) { return 0.2; })), "");
}

}  // namespace
}  // namespace nacre
