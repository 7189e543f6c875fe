// Nacre: two sheets in one place: either side shows its own flow and its own colours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compute/device/device.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"

namespace nacre::test {
namespace {

/// A wall without thickness beside a floor: up it flows along +x and the colour is red, down along -x and blue. The
/// polygons of its sides are divided into triangles in different ways.
class TwoSheets : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    choose_embedding(pipeline_->parameters, GetParam());
    pipeline_->parameters.resolution = 64;
    pipeline_->embed({points_, triangles_, normals_, second_});
    vectors_.reference_speed = 1;
    vectors_.at = [](double, std::span<Vec3f> out) {
      ASSERT_EQ(out.size(), 12u) << "one for each point of the file";
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = {i < 4 || i >= 8 ? 1.0f : -1.0f, 0, 0};
    };
    pipeline_->flow().start(vectors_);
    for (int k = 0; k < 3; ++k) pipeline_->flow().step();
  }

  /// Red, green and blue in the middle of the picture, seen from above or below.
  std::array<double, 3> colour(double side, BackFaces back_faces = BackFaces::shown) const {
    RenderOptions options;
    options.width = options.height = 24;
    options.camera.eye = {0.5, 0.5, 3 * side};
    options.camera.target = {0.5, 0.5, 0};
    options.camera.up = {0, 1, 0};
    options.camera.height = 0.8;
    options.scalar = scalar_;
    std::vector<std::array<float, 3>> colours(256, {1, 0, 0});
    std::fill(colours.begin() + 128, colours.end(), std::array<float, 3>{0, 0, 1});
    options.colours = colours;
    options.back_faces = back_faces;
    const std::vector<std::uint8_t> picture = pipeline_->flow().render(options);
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < picture.size(); ++i)
      if (i % 4 < 3) sum[i % 4] += picture[i] / (24.0 * 24.0);
    return sum;
  }

  const std::vector<Vec3d> points_{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0},   {1, 0, 0},
                                   {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 0.5}, {0, 0, 0.5}};
  const std::vector<Triangle> triangles_{{0, 1, 2}, {0, 2, 3}, {8, 9, 10}, {8, 10, 11}, {4, 7, 5}, {7, 6, 5}};
  const std::vector<std::uint8_t> second_{0, 0, 0, 0, 1, 1};
  std::vector<Vec3f> normals_ = [] {
    std::vector<Vec3f> n(12, Vec3f(0, 0, 1));
    std::fill(n.begin() + 6, n.end(), Vec3f(1, 0, 0));
    n.resize(18, Vec3f(0, 0, -1));
    return n;
  }();
  const std::vector<float> scalar_{0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0};
  const std::unique_ptr<Device> device_ = make_cpu_device();
  const std::unique_ptr<FlowPipeline> pipeline_ = make_flow_pipeline(*device_);
  FlowVectors vectors_;
};

TEST_P(TwoSheets, EitherHasItsOwnCellsAndVectors) {
  const FlowValues values = pipeline_->flow().values();
  const double cell = pipeline_->flow().embedding().cell_size;
  int up = 0, down = 0;
  for (std::size_t i = 0; i < values.value.size(); ++i) {
    ASSERT_LT(std::fabs(values.closest_point[i].z), 0.51) << "where the file has it";
    ASSERT_LT(length(values.centre[i] - values.closest_point[i]), cell);
    if (std::fabs(values.normal[i].z) < 0.5f) continue;  // of the floor
    ASSERT_NEAR(values.velocity[i].x, values.normal[i].z, 1e-4);
    ++(values.normal[i].z > 0 ? up : down);
  }
  EXPECT_GT(up, 2000);
  EXPECT_NEAR(up, down, 0.05 * up);
}

TEST_P(TwoSheets, TheOneThatFacesTheCameraIsSeen) {
  const auto above = colour(1), below = colour(-1);
  EXPECT_GT(above[0], 60);
  EXPECT_EQ(above[2], 0);
  EXPECT_GT(below[2], 60);
  EXPECT_EQ(below[0], 0);
}

TEST_P(TwoSheets, CellsAreAsLargeAsWithoutThem) {
  const double cell = pipeline_->flow().embedding().cell_size;
  pipeline_->embed({points_, std::span(triangles_).first(4), std::span(normals_).first(12)});
  EXPECT_DOUBLE_EQ(pipeline_->flow().embedding().cell_size, cell);
}

/// The floor alone, from behind.
TEST_P(TwoSheets, BackFacesAsChosen) {
  pipeline_->embed({points_, std::span(triangles_).first(4), std::span(normals_).first(12)});
  vectors_.at = [](double, std::span<Vec3f> out) { std::fill(out.begin(), out.end(), Vec3f(1, 0, 0)); };
  pipeline_->flow().start(vectors_);
  const auto front = colour(1), back = colour(-1);
  EXPECT_NEAR(back[0], front[0], 25) << "the same colour, in another light";
  EXPECT_EQ(back[2], 0);
  const auto neutral = colour(-1, BackFaces::neutral);
  EXPECT_GT(neutral[1], 60);
  EXPECT_EQ(neutral[0], neutral[1]);
  EXPECT_EQ(colour(1, BackFaces::neutral), front);
  const auto hidden = colour(-1, BackFaces::hidden);
  EXPECT_NEAR(hidden[1], 255, 1e-9) << "the background";
  EXPECT_EQ(colour(1, BackFaces::hidden), front);
}

INSTANTIATE_TEST_SUITE_P(By, TwoSheets, ::testing::Values("grid", "brick", "thesis"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace nacre::test
