// Nacre: sizes of materials and regions: from text, and in meshes.
#include "compute/pipeline/size_bounds.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "compute/device/device.hpp"
#include "compute/device/error.hpp"
#include "compute/device/random.hpp"
#include "compute/pipeline/volume_frame.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

MeshVolume two_balls() {
  MeshVolume volume = label_volume({52, 26, 26}, 3, [](const Vec3d& p) {
    return length(p - Vec3d(13, 13, 13)) < 9 ? 1 : length(p - Vec3d(38, 13, 13)) < 9 ? 2 : 0;
  });
  volume.names = {"outside", "left", "right, upper"};
  return volume;
}

std::string refusal(const std::string& text) {
  try {
    size_bounds(text, two_balls());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Mean length of the edges of triangles whose centre `is_in` accepts.
template <class Accept>
double mean_edge(const SurfaceMesh& mesh, const Accept& is_in) {
  double sum = 0;
  int count = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d corner[3] = {mesh.points[t.a], mesh.points[t.b], mesh.points[t.c]};
    if (!is_in((corner[0] + corner[1] + corner[2]) / 3.0)) continue;
    for (int k = 0; k < 3; ++k) sum += length(corner[k] - corner[(k + 1) % 3]), ++count;
  }
  EXPECT_GT(count, 30);
  return sum / std::max(count, 1);
}

SurfaceMesh mesh_with(const std::string& sizes, double max_size) {
  const std::unique_ptr<Device> device = make_cpu_device(2);
  const std::unique_ptr<MeshPipeline> pipeline = make_mesh_pipeline(*device);
  pipeline->parameters.sizes = sizes;
  pipeline->parameters.max_size = max_size;
  pipeline->parameters.epsilon = 3;  // the balls are not narrow
  pipeline->parameters.delta = 1;
  pipeline->parameters.quality = "draft";
  const MeshVolume volume = two_balls();
  pipeline->load(volume);
  pipeline->build_fields();
  pipeline->relax();
  return pipeline->triangulate();
}

TEST(SizeBounds, AreReadFromText) {
  const std::vector<SizeBound> bounds = size_bounds(" 1:0.5, left : 2,ball 38 13 13 5:0.25 ", two_balls());
  ASSERT_EQ(bounds.size(), 3u);
  EXPECT_EQ(bounds[0].kind, SizeBound::Kind::material);
  EXPECT_EQ(bounds[0].material, 1u);
  EXPECT_FLOAT_EQ(bounds[0].size, 0.5f);
  EXPECT_EQ(bounds[1].material, 1u);
  EXPECT_EQ(bounds[2].kind, SizeBound::Kind::ball);
  EXPECT_TRUE(size_bounds("", two_balls()).empty());
}

TEST(SizeBounds, SayWhatCannotBeRead) {
  EXPECT_NE(refusal("1").find("there is no colon before the size"), std::string::npos);
  EXPECT_NE(refusal("1:0").find("not a number from 0.05 to 1000"), std::string::npos);
  EXPECT_NE(refusal("1:nan").find("not a number from 0.05 to 1000"), std::string::npos);
  EXPECT_NE(refusal("1:1,7:1").find("there is no material '7'; the labels are 0, 1, 2"), std::string::npos);
  EXPECT_NE(refusal("1:1,7:1").find("at '7:1'"), std::string::npos);
  EXPECT_NE(refusal("box 0 0 0 1 1:1").find("a box has six numbers"), std::string::npos);
  EXPECT_NE(refusal("box 0 0 0 1 0 1:1").find("the box is empty"), std::string::npos);
  EXPECT_NE(refusal("ball 0 0 x 1:1").find("'x' is not a number"), std::string::npos);
  EXPECT_NE(refusal("ball 0 0 0 -1:1").find("the radius is not positive"), std::string::npos);
}

/// Regions are boxes and balls of the world, whatever the volume's axes and spacing are.
TEST(SizeBounds, RegionsAreOfTheWorld) {
  MeshVolume volume = two_balls();
  volume.spacing = {0.5, 1, 2};
  volume.origin = {10, -4, 3};
  volume.axes = {Vec3d(0, 1, 0), Vec3d(-0.6, 0, 0.8), Vec3d(0.8, 0, 0.6)};
  const VolumeFrame frame(volume);
  const SizeBound box = size_bounds("box 9 -2 4 13 3 9:1", volume)[0], ball = size_bounds("ball 11 0 6 2:1", volume)[0];
  int inside = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3d world(8 + 6 * uniform_random(3, k, 0), -3 + 7 * uniform_random(3, k, 1),
                      3 + 7 * uniform_random(3, k, 2));
    const Vec3f p(frame.to_voxels(world));
    const bool in_box = world.x > 9 && world.x < 13 && world.y > -2 && world.y < 3 && world.z > 4 && world.z < 9;
    const double away = length(world - Vec3d(11, 0, 6));
    EXPECT_EQ(box.holds(p, Junction()), in_box) << k;
    if (std::fabs(away - 2) > 1e-4) {
      EXPECT_EQ(ball.holds(p, Junction()), away < 2) << k;
    }
    inside += in_box;
  }
  EXPECT_GT(inside, 300);
}

bool at_left(const Vec3d& p) { return p.x < 25; }
bool at_right(const Vec3d& p) { return p.x > 25; }

/// Each ball has the triangles that it has where all are of that size.
TEST(SizeBounds, AMaterialHasItsOwnSize) {
  const SurfaceMesh mesh = mesh_with("1:0.8,2:2", 1.2);
  const double fine = mean_edge(mesh_with("", 0.8), at_left), coarse = mean_edge(mesh_with("", 2), at_right);
  EXPECT_GT(coarse, 2 * fine);
  EXPECT_NEAR(mean_edge(mesh, at_left), fine, 0.05 * fine);
  EXPECT_NEAR(mean_edge(mesh, at_right), coarse, 0.05 * coarse);
}

TEST(SizeBounds, ARegionHasItsOwnSize) {
  const auto below = [](const Vec3d& p) { return p.x > 28 && p.z < 11; };
  const SurfaceMesh mesh = mesh_with("box 27 0 0 60 30 13:0.9", 2);
  const double fine = mean_edge(mesh_with("", 0.9), below), coarse = mean_edge(mesh_with("", 2), at_left);
  EXPECT_NEAR(mean_edge(mesh, below), fine, 0.05 * fine);
  EXPECT_NEAR(mean_edge(mesh, at_left), coarse, 0.05 * coarse);
}

}  // namespace
}  // namespace nacre::test
