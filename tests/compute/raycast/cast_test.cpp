// Nacre: rays find the surface from everywhere, and end.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "compute/device/device.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {
namespace {

Triangle triangle(int a, int b, int c) { return {std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)}; }

struct Box {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  std::vector<Vec3f> normals;

  Box() {
    for (int k = 0; k < 8; ++k) points.push_back({k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0});
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : quads)
      for (const Triangle t : {triangle(q[0], q[1], q[2]), triangle(q[0], q[2], q[3])}) {
        triangles.push_back(t);
        const Vec3f n(normalized(cross(points[t.b] - points[t.a], points[t.c] - points[t.a])));
        for (int k = 0; k < 3; ++k) normals.push_back(n);
      }
  }
};

/// Share of the picture that shows the surface.
double coverage(FlowPipeline& pipeline, const Camera& camera, int size) {
  RenderOptions options;
  options.camera = camera;
  options.width = options.height = size;
  options.samples = 1;
  options.transparent = true;
  const std::vector<std::uint8_t> image = pipeline.flow().render(options);
  double seen = 0;
  for (std::size_t i = 3; i < image.size(); i += 4) seen += image[i] > 127;
  return seen / (double(size) * size);
}

class RaysAtABox : public testing::Test {
 protected:
  RaysAtABox() : device(make_cpu_device()), pipeline(make_flow_pipeline(*device)) {
    pipeline->parameters.resolution = 128;
    pipeline->embed({box.points, box.triangles, box.normals});
  }

  Box box;
  std::unique_ptr<Device> device;
  std::unique_ptr<FlowPipeline> pipeline;
};

/// Straight at a face all rays are parallel to two axes, some of them along walls of the grid: exact, and quick.
TEST_F(RaysAtABox, AxisParallelViewsSeeExactlyOneFace) {
  for (const char* view : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
    Camera camera = fit_camera(view, {-1, -1, -1}, {1, 1, 1}, 200, 200);
    camera.orthographic = true;
    camera.height = 4;
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NEAR(coverage(*pipeline, camera, 200), 0.25, 0.006) << view;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20) << view;
  }
}

/// Along the diagonal a cube shows a regular hexagon of area 2 sqrt 3 for edge 2.
TEST_F(RaysAtABox, DiagonalViewSeesAHexagon) {
  Camera camera;
  camera.eye = {9, 9, 9};
  camera.target = {0, 0, 0};
  camera.up = {0, 0, 1};
  camera.orthographic = true;
  camera.height = 4;
  EXPECT_NEAR(coverage(*pipeline, camera, 200), 4 * std::sqrt(3.0) / 16, 0.006);
}

/// However far the eye is, in cells beyond what single precision counts one by one: no ray stands still or falls
/// through.
TEST_F(RaysAtABox, ADistantCameraSeesTheSame) {
  for (const double distance : {20.0, 300.0, 1e4, 1e6}) {
    Camera camera;
    camera.eye = normalized(Vec3d(1, 1, 1)) * distance;
    camera.target = {0, 0, 0};
    camera.up = {0, 0, 1};
    camera.height = 4;
    for (const bool orthographic : {true, false}) {
      camera.orthographic = orthographic;
      EXPECT_NEAR(coverage(*pipeline, camera, 200), 4 * std::sqrt(3.0) / 16, orthographic ? 0.006 : 0.03) << distance;
    }
    camera.height = 4 * distance;  // and far away in the picture, too: the box is smaller than a pixel there
    EXPECT_LT(coverage(*pipeline, camera, 50), 0.1) << distance;
  }
}

TEST_F(RaysAtABox, ACameraInsideSeesTheSurfaceEverywhere) {
  Camera camera;
  camera.eye = {0, 0, 0.1};
  camera.target = {1, 0, 0.1};
  camera.up = {0, 0, 1};
  camera.height = 2;
  EXPECT_EQ(coverage(*pipeline, camera, 64), 1.0);
}

TEST_F(RaysAtABox, ACameraThatLooksAwaySeesNothing) {
  Camera camera;
  camera.eye = {5, 0, 0};
  camera.target = {9, 0, 0};
  camera.up = {0, 0, 1};
  EXPECT_EQ(coverage(*pipeline, camera, 64), 0.0);
}

}  // namespace
}  // namespace nacre
