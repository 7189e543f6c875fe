// Nacre: slices of a volume in any direction. No OpenGL here.
#include "app/viewer/mesh/viewed_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace nacre {
namespace {

/// The values of a linear function of the world, in a volume that is turned and has voxels of two lengths.
ViewedVolume linear_volume(const Vec3d& slope) {
  ViewedVolume v;
  v.input.kind = MeshVolume::Kind::scalar;
  v.input.dims = {24, 20, 16};
  v.input.spacing = {1, 1, 2};
  v.input.origin = {3, -4, 5};
  v.input.axes = {Vec3d(0.6, 0.8, 0), Vec3d(-0.8, 0.6, 0), Vec3d(0, 0, 1)};
  std::vector<float> values;
  for (int z = 0; z < v.input.dims.z; ++z)
    for (int y = 0; y < v.input.dims.y; ++y)
      for (int x = 0; x < v.input.dims.x; ++x) {
        values.push_back(float(dot(slope, v.to_world({double(x), double(y), double(z)}))));
        v.material.push_back(x < 12 ? 1 : 2);
      }
  Volume volume;
  volume.dims = v.input.dims;
  volume.values = std::move(values);
  v.volumes = std::make_shared<const std::vector<Volume>>(std::vector<Volume>{std::move(volume)});
  return v;
}

TEST(SliceInAnyDirection, ShowsTheValuesThatAreThere) {
  const Vec3d slope(1, -0.5, 0.7);
  const ViewedVolume v = linear_volume(slope);
  const std::vector<Vec3d> corners = v.box();
  const Vec3d middle = (corners.front() + corners.back()) * 0.5;
  const WorldPlane wanted{normalized(Vec3d(1, 2, 0.5)), middle};
  const std::optional<SlicePlane> plane = slice_plane(v, wanted);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(dot(plane->corner - middle, wanted.normal), 0, 1e-9);
  EXPECT_NEAR(dot(plane->across, plane->up), 0, 1e-9);
  EXPECT_TRUE(plane->is_oblique());
  Colormap map{"ramp", "gray", {}};
  for (int k = 0; k < 256; ++k) map.table.push_back({float(k) / 255, float(k) / 255, float(k) / 255});
  const Image image = volume_slice(v, *plane, {}, map, -20, 60);
  const std::vector<Vec3d> positions = plane->positions(image.width, image.height);
  int inside = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const Vec3d voxel = v.to_voxels(positions[k]);
    bool near_edge = false;
    for (int a = 0; a < 3; ++a) near_edge = near_edge || voxel[a] < 0 || voxel[a] > v.input.dims[a] - 1;
    EXPECT_EQ(image.pixels[4 * k + 3], v.index_at(positions[k]) ? 255 : 0);
    if (near_edge) continue;  // there the last value holds
    ++inside;
    EXPECT_NEAR(image.pixels[4 * k], 255 * (dot(slope, positions[k]) + 20) / 80, 1.01);
  }
  EXPECT_GT(inside, 200);
}

TEST(SliceInAnyDirection, ContainsAllOfThePlaneWithinTheVolume) {
  const ViewedVolume v = linear_volume({1, 0, 0});
  const std::vector<Vec3d> corners = v.box();
  const Vec3d middle = (corners.front() + corners.back()) * 0.5;
  const std::optional<SlicePlane> straight = slice_plane(v, {{0, 0, 1}, middle});
  ASSERT_TRUE(straight);
  // 24 by 20 units, turned by the angle of 3, 4, 5
  EXPECT_NEAR(length(straight->across), 24 * 0.6 + 20 * 0.8, 1e-9);
  EXPECT_NEAR(length(straight->up), 24 * 0.8 + 20 * 0.6, 1e-9);
  EXPECT_FALSE(slice_plane(v, {{0, 0, 1}, middle + Vec3d(0, 0, 100)}));
}

TEST(SliceInAnyDirection, IsTheFirstPlaneOfTheKnob) {
  const ViewedVolume v = linear_volume({1, 0, 0});
  ViewSettings view;
  EXPECT_FALSE(wanted_slice(v, view));
  view.slice = PlaneAxis::plane;
  EXPECT_FALSE(wanted_slice(v, view)) << "there is no plane";
  view.clip_planes = "0 0 1 0 0 12;1 0 0 0 0 0";
  const std::optional<SlicePlane> plane = wanted_slice(v, view);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->corner.z, 12, 1e-9);
  view.slice = PlaneAxis::z;
  EXPECT_FALSE(wanted_slice(v, view)->is_oblique());
}

}  // namespace
}  // namespace nacre
