// Nacre: colours of a flow in the viewer: the range, what lies beyond it, and what is no number; as without OpenGL.
#include <cmath>

#include "app/viewer/flow/flow_scene.hpp"
#include "app/viewer/scene/scene_view.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/run/shown_colours.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/viewer/scene_in_view.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

using Rgb = std::array<int, 3>;

/// A sphere whose points have a value that is its z, or no number where y is above a half.
class ColoursInView : public test::SceneInView<FlowScene> {
 protected:
  void open() {
    Surface surface = make_sample("sphere", 32).load(0);
    std::vector<float> height;
    for (const Vec3d& p : surface.points) height.push_back(p.y > 0.5 ? std::nanf("") : float(p.z));
    surface.arrays.push_back({"height", 1, height});
    write_surface(folder_ / "a.vtp", surface);
    session_.inputs = {folder_ / "a.vtp"};
    session_.settings.color = "height";
    session_.settings.colormap = "gray";
    session_.settings.flow.resolution = 48;
    session_.settings.view.ambient = 1;
    scene_ = std::make_unique<FlowScene>(session_, make_cpu_device(2), false);
    while (scene_->results().data.array.empty() || scene_->corners().empty()) scene_->advance(-1e9);
  }
  /// Seen from -y, at a share of the picture from its left and its top: without texture, all light is ambient.
  Rgb at(double x, double y, const char* from = "-y") {
    View view = scene_view(session_, scene_->corners(), 0, 100, 100);
    view.camera = fit_camera(from, scene_->corners(), 100, 100);
    const Framebuffer frame(100, 100);
    frame.bind();
    frame.clear({0, 0, 1, 1});
    scene_->draw(view);
    const Image image = frame.read();
    const std::size_t k = 4 * (std::size_t(100 * y) * 100 + std::size_t(100 * x));
    return {image.pixels[k], image.pixels[k + 1], image.pixels[k + 2]};
  }

  test::TemporaryFolder folder_;
};

TEST_F(ColoursInView, WhatLiesBeyondTheRangeAndWhatIsNoNumber) {
  open();
  const Rgb low = at(0.5, 0.75), high = at(0.5, 0.25);
  EXPECT_LT(low[0], high[0]);
  EXPECT_EQ(low[0], low[2]) << "gray";
  change([](Settings& s) {
    s.color_range = "-0.2:0.2";
    s.color_below = "#00ff00";
    s.color_above = "#ff0000";
    s.color_nan = "#ff00ff";
  });
  EXPECT_EQ(at(0.5, 0.75), (Rgb{0, 255, 0}));
  EXPECT_EQ(at(0.5, 0.25), (Rgb{255, 0, 0}));
  EXPECT_EQ(at(0.5, 0.5, "+y"), (Rgb{255, 0, 255}));
  EXPECT_TRUE(scene_->results().colours.scale.no_number) << "the legend says so";
  change([](Settings& s) { s.color_below = s.color_above = ""; });
  EXPECT_EQ(at(0.5, 0.25), (Rgb{255, 255, 255})) << "the end of the map";
}

TEST_F(ColoursInView, SymmetricAndLogarithmicRanges) {
  open();
  const double least = scene_->results().data.colours.least_positive;
  EXPECT_GT(least, 0);
  change([](Settings& s) { s.color_range = "-0.1:0.8", s.color_symmetric = true; });
  EXPECT_DOUBLE_EQ(scene_->results().colours.range.low, -0.8);
  const int linear = at(0.5, 0.35)[0];
  change([](Settings& s) { s.color_symmetric = false, s.color_range = "0.01:1", s.color_scale = ColourScale::log; });
  EXPECT_TRUE(scene_->results().colours.range.log);
  EXPECT_GT(at(0.5, 0.35)[0], linear) << "small values lie higher on the map";
  EXPECT_EQ(at(0.5, 0.75), at(0.5, 0.7)) << "what has no logarithm lies at the lower end";
}

TEST_F(ColoursInView, AWishThatMakesNoSenseIsToldAndLeavesTheDatasRange) {
  open();
  const double low = scene_->results().data.colours.low;
  change([](Settings& s) { s.color_range = "3:1"; });
  EXPECT_EQ(scene_->results().colours.range.low, low);
  EXPECT_FALSE(scene_->warnings().empty());
}

}  // namespace
}  // namespace nacre
