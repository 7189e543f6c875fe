// Nacre: focus in the viewer: a close-up becomes sharp once the camera rests, and nothing stale is shown.
#include "engine/run/focus.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "app/viewer/flow/flow_scene.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "tests/app/viewer/scene_in_view.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

class FocusInView : public test::SceneInView<FlowScene> {
 protected:
  static constexpr int size = 160;

  void SetUp() override {
    test::Offscreen::SetUp();
    if (IsSkipped()) return;
    session_.sample = "sphere";
    session_.detail = 24;
    session_.settings.flow.resolution = 48;
    session_.settings.flow.steps = 8;
    session_.settings.color = "none";
    session_.settings.view.play = false;
  }

  void open(bool lockstep = false) {
    scene_ = std::make_unique<FlowScene>(session_, make_cpu_device(2), true, true);
    scene_->set_lockstep(lockstep);
    const std::atomic<bool> never{false};
    scene_->advance_and_wait(never);
    ASSERT_TRUE(scene_->complete());
  }

  /// The camera of the whole, or that much nearer to a point of the surface, and moved to the side.
  void look(double zoom, double aside = 0) {
    camera_ = fit_camera("iso", scene_->corners(), size, size);
    const Vec3d to_side = camera_.right() * aside;
    camera_.target = (zoom > 1 ? -camera_.forward() : camera_.target) + to_side;
    camera_.eye = camera_.target - camera_.forward() * 4.0;
    camera_.height /= zoom;
    camera_.orthographic = true;
  }

  Image frame() {
    View view;
    view.width = view.height = size;
    view.camera = camera_;
    view.light = flow_light(view.camera);
    const Framebuffer target(size, size);
    target.bind();
    target.clear({1, 1, 1, 1});
    scene_->draw(view);
    scene_->advance(now_ += 0.04);
    return target.read();
  }

  bool frames_until(const std::function<bool()>& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (!done() && std::chrono::steady_clock::now() < end) {
      frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return done();
  }

  bool becomes_focused() {
    return frames_until([&] { return scene_->focused(); });
  }

  /// Many frames, more than a camera has to rest for.
  void let_pass() {
    for (int k = 0; k < 30; ++k) frame();
    frames_until([&] { return scene_->settled(); });
    frame();
  }

  /// Mean difference between pixels beside each other, 0..255.
  static double sharpness(const Image& image) {
    double sum = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x + 1 < size; ++x) sum += std::abs(int(image.at(x, y)[0]) - int(image.at(x + 1, y)[0]));
    return sum / (double(size) * size);
  }

  /// Mean difference between two pictures, 0..255.
  static double difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); k += 4) sum += std::abs(int(a.pixels[k]) - int(b.pixels[k]));
    return sum / (double(size) * size);
  }

  std::size_t remarks(const std::string& part) const {
    return std::size_t(std::count_if(scene_->warnings().begin(), scene_->warnings().end(),
                                     [&](const std::string& w) { return w.find(part) != std::string::npos; }));
  }

  Camera camera_;
  double now_ = 0;
};

using LongFocusInView = FocusInView;

TEST_F(FocusInView, ACloseUpBecomesSharpAndGoingBackOutIsImmediate) {
  for (const EmbeddingKind method : {EmbeddingKind::grid, EmbeddingKind::octree}) {
    session_.settings.flow.method = method;
    open();
    look(1);
    let_pass();
    EXPECT_FALSE(scene_->focused()) << "all of the surface is in view";
    for (const double zoom : {8.0, 20000.0}) {
      look(zoom);
      const double coarse = sharpness(frame());
      ASSERT_TRUE(becomes_focused()) << zoom;
      const double fine = sharpness(frame());
      std::printf("zoom %g: mean difference between neighbours: %.2f, focused %.2f\n", zoom, coarse, fine);
      EXPECT_GT(fine, 3 * coarse) << zoom;
      EXPECT_GT(fine, 8) << zoom;
      look(1);
      frame();
      EXPECT_FALSE(scene_->focused()) << "with the next frame";
      EXPECT_EQ(scene_->focuses(), 0u);
    }
  }
}

TEST_F(FocusInView, IsFadedInOverTheTextureOfTheWhole) {
  open();
  look(16);
  std::vector<Image> frames;
  ASSERT_TRUE(frames_until([&] {
    frames.push_back(frame());
    return scene_->focused();
  }));
  frames.push_back(frame());
  double largest = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) largest = std::max(largest, difference(frames[k - 1], frames[k]));
  const double in_all = difference(frames.front(), frames.back());
  std::printf("largest difference between two frames: %.2f, of the first and the last: %.2f\n", largest, in_all);
  EXPECT_GT(in_all, 5);
  EXPECT_LT(largest, 0.5 * in_all);
}

TEST_F(FocusInView, ItMovesWithTheFlow) {
  open();
  look(16);
  ASSERT_TRUE(becomes_focused());
  const Image before = frame();
  change([](Settings& s) { s.view.play = true; });
  const int steps = scene_->steps();
  ASSERT_TRUE(frames_until([&] { return scene_->steps() >= steps + 12; })) << "past the end of the data";
  EXPECT_TRUE(scene_->focused());
  const Image after = frame();
  EXPECT_GT(difference(before, after), 5);
  EXPECT_GT(sharpness(after), 0.7 * sharpness(before));
}

TEST_F(FocusInView, ChangesDropItAtOnce) {
  open();
  look(16);
  ASSERT_TRUE(becomes_focused());
  change([](Settings& s) { s.flow.seed = 7; });
  EXPECT_EQ(scene_->focuses(), 0u) << "at once";
  ASSERT_TRUE(becomes_focused()) << "and comes again";
  change([](Settings& s) { s.begin_at = 0.5; });
  EXPECT_EQ(scene_->focuses(), 0u);
  ASSERT_TRUE(becomes_focused());
  change([](Settings& s) { s.focus = false; });
  EXPECT_EQ(scene_->focuses(), 0u);
  let_pass();
  EXPECT_FALSE(scene_->focused());
  change([](Settings& s) { s.focus = true; });
  ASSERT_TRUE(becomes_focused());
  const Image grey = frame();
  change([](Settings& s) { s.color = "speed"; });
  ASSERT_TRUE(frames_until([&] { return difference(frame(), grey) > 5; })) << "it has the colours of the whole";
}

TEST_F(FocusInView, FramesOfBeforeAreShownWithoutIt) {
  open();
  look(16);
  ASSERT_TRUE(becomes_focused());
  const Image coarse = [&] {
    change([](Settings& s) { s.focus = false; });
    const Image seen = frame();
    change([](Settings& s) { s.focus = true; });
    return seen;
  }();
  ASSERT_TRUE(becomes_focused());
  const int at = scene_->transport().shown;
  change([](Settings& s) { s.begin_at = 1.0 / 8; });  // one step forth
  ASSERT_TRUE(frames_until([&] { return scene_->transport().shown == at + 1 && scene_->focused(); }));
  change([](Settings& s) { s.begin_at = 0; });
  ASSERT_EQ(scene_->transport().shown, at);
  EXPECT_EQ(frame().pixels, coarse.pixels) << "the focus is at another time";
}

/// Views come faster than a focus is made; knobs and time change meanwhile.
TEST_F(LongFocusInView, ManyMovesLeaveNothingBehind) {
  open();
  look(16);
  ASSERT_TRUE(becomes_focused());
  const std::size_t peak = scene_->totals().peak_bytes;
  std::size_t most = 0;
  for (int k = 0; k < 1000; ++k) {
    look(k % 7 == 0 ? 1 : 8 + k % 5, 0.002 * (k % 11));
    for (int still = 0; still < (k % 10 == 0 ? 8 : 1); ++still) frame();
    if (k % 50 == 25) change([&](Settings& s) { s.flow.step_cells = 4 + k % 3; });
    if (k % 50 == 40) change([&](Settings& s) { s.begin_at = 0.25 * (k % 4); });
    if (k % 50 == 45) change([&](Settings& s) { s.view.play = !s.view.play; });
    most = std::max(most, scene_->focuses());
  }
  look(16);
  ASSERT_TRUE(becomes_focused());
  EXPECT_TRUE(scene_->failure().empty()) << scene_->failure();
  EXPECT_LE(most, 5u);
  EXPECT_LT(scene_->totals().peak_bytes, 2 * peak);
  EXPECT_TRUE(scene_->warnings().empty()) << scene_->warnings().front();
}

TEST_F(FocusInView, ComesAfterAnUndoThatShowsKeptFrames) {
  open();
  look(1);
  let_pass();
  for (const double step_cells : {5.0, session_.settings.flow.step_cells, 5.0}) {
    change([&](Settings& s) { s.flow.step_cells = step_cells; });
    let_pass();
  }
  look(16);
  EXPECT_TRUE(becomes_focused());
}

TEST_F(FocusInView, ViewsThatShowNothingOrStandInsideHaveNone) {
  open();
  look(16, 50);
  let_pass();
  EXPECT_EQ(scene_->focuses(), 0u);
  camera_.eye = {0, 0, 0};  // the middle of the sphere, with perspective
  camera_.target = {0.1, 0, 0};
  camera_.height = 0.01;
  camera_.orthographic = false;
  let_pass();
  camera_.target = camera_.eye;
  let_pass();
  camera_.target = {1, 0, 0};
  camera_.height = 0;
  let_pass();
  look(16);
  EXPECT_TRUE(becomes_focused());
  EXPECT_TRUE(scene_->failure().empty()) << scene_->failure();
}

TEST_F(FocusInView, FramesOfReplaysWaitForIt) {
  open(true);
  look(16);
  const Image first = frame();
  EXPECT_TRUE(scene_->focused()) << "in the first frame";
  EXPECT_GT(sharpness(first), 8);
  look(16, 0.5);
  std::vector<Image> frames{frame()};
  for (int k = 0; k < 12; ++k) frames.push_back(frame());
  EXPECT_TRUE(scene_->focused());
  double largest = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) largest = std::max(largest, difference(frames[k - 1], frames[k]));
  const double in_all = difference(frames.front(), frames.back());
  std::printf("largest difference between two frames: %.2f, of the first and the last: %.2f\n", largest, in_all);
  EXPECT_GT(in_all, 5);
  EXPECT_LT(largest, 0.5 * in_all) << "it is faded in after the camera has moved";
}

TEST_F(FocusInView, FramesOfACameraThatMovesInAReplayStaySharp) {
  open(true);
  look(8, 0);
  const double at_rest = sharpness(frame());
  double least = at_rest;
  for (int k = 1; k <= 24; ++k) {  // two widths of the view to the side, along the sphere
    look(8, 0.02 * k);
    least = std::min(least, sharpness(frame()));
  }
  session_.settings.focus = false;
  scene_.reset();
  open(true);
  look(8, 0.2);
  const double coarse = sharpness(frame());
  std::printf("sharpness: %.1f at rest, at least %.1f on the way, %.1f without a focus\n", at_rest, least, coarse);
  EXPECT_GT(at_rest, 2 * coarse);
  EXPECT_GT(least, 0.6 * at_rest);
}

/// A sphere, and a view of a part of it.
struct CloseUp {
  PreparedSurface sphere;
  FlowParameters parameters;
  FlowView view;

  CloseUp(int detail, int width, int height, double zoom) : sphere(prepare(make_sample("sphere", detail).load(0), 40)) {
    parameters.resolution = 48;
    view = {fit_camera("+x", triangle_corners(sphere), width, height), width, height};
    view.camera.height /= zoom;
  }
};

TEST(FocusServes, OtherViewsOfWhatItShowsNoNearer) {
  const auto [sphere, parameters, view] = CloseUp(48, 400, 300, 8);
  const auto focus_of = [&](const FlowView& v) {
    return focus_on(v, sphere, parameters, std::size_t(1) << 34, picture_budget(v));
  };
  const std::optional<Focus> focus = focus_of(view), wide = focus_of(widened(view, 1.4));
  ASSERT_TRUE(focus && wide);
  const auto served = [&](const Focus& by, const FlowView& v) { return serves(by.shown, by.cell_size, v, sphere); };
  const auto moved = [&](double share) {  // of the height of the view
    FlowView v = view;
    const Vec3d aside = v.camera.right() * (share * v.camera.height);
    v.camera.eye += aside, v.camera.target += aside;
    return v;
  };
  EXPECT_TRUE(served(*focus, view));
  EXPECT_FALSE(served(*focus, moved(0.1)));
  EXPECT_TRUE(served(*wide, moved(0.1)));
  EXPECT_FALSE(served(*wide, moved(0.4)));
  FlowView near = view, far = view, behind = view;
  near.camera.height /= 2;
  EXPECT_FALSE(served(*focus, near)) << "its cells are too large";
  far.camera.height *= 1.2;
  EXPECT_FALSE(served(*focus, far)) << "more is seen";
  EXPECT_TRUE(served(*wide, far));
  behind.camera.eye = view.camera.target * 2 - view.camera.eye;
  EXPECT_FALSE(served(*wide, behind));
  behind.camera.target = behind.camera.eye * 2 - view.camera.target;  // away from the surface
  EXPECT_TRUE(served(*focus, behind)) << "nothing is seen";
  EXPECT_NEAR(wide->cell_size, focus->cell_size, 0.2 * focus->cell_size) << "pixels are as large";
}

TEST(FocusBudget, AFocusThatDoesNotFitTheMemoryIsCoarserAndSaysSo) {
  CloseUp close_up(24, 1000, 750, 16);
  auto& [sphere, parameters, view] = close_up;
  for (const EmbeddingKind method : {EmbeddingKind::grid, EmbeddingKind::octree}) {
    parameters.method = method;
    const auto in = [&](std::size_t bytes) { return focus_on(view, sphere, parameters, bytes, picture_budget(view)); };
    const std::optional<Focus> enough = in(std::size_t(1) << 34);
    ASSERT_TRUE(enough);
    FlowParameters finest = parameters;
    finest.resolution = enough->resolution;
    const FlowMesh mesh = flow_mesh(enough->part.surface);
    const double needed =
        method == EmbeddingKind::grid ? estimate_flow_bytes(mesh, finest) : estimate_octree_bytes(mesh, finest);
    const std::optional<Focus> little = in(std::size_t(0.8 * needed));
    ASSERT_TRUE(little);
    EXPECT_EQ(enough->resolution, enough->wanted);
    EXPECT_TRUE(coarser_than_pixels(*enough).empty());
    EXPECT_EQ(little->wanted, enough->wanted);
    EXPECT_LT(little->resolution, enough->resolution);
    EXPECT_FALSE(coarser_than_pixels(*little).empty());
    EXPECT_FALSE(in(1));
    const std::optional<Focus> in_window = focus_on(view, sphere, parameters, std::size_t(1) << 34, 2e4);
    ASSERT_TRUE(in_window);
    EXPECT_LT(in_window->resolution, enough->resolution) << "a smaller budget";
  }
}

TEST(FocusBudget, APartWithoutAreaHasNone) {
  Surface flat;
  flat.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  flat.triangles = {{0, 1, 2}, {1, 3, 2}};
  const PreparedSurface plane = prepare(flat, 40);
  FlowParameters parameters;
  parameters.resolution = 48;
  FlowView view{{{-5, 0.5, 0}, {0.5, 0.5, 0}, {0, 0, 1}, 0.01, true}, 400, 300};  // along the plane
  EXPECT_FALSE(focus_on(view, plane, parameters, std::size_t(1) << 34, picture_budget(view)));
}

TEST_F(FocusInView, SurfacesThatMoveSayOnceThatTheyHaveNone) {
  const test::TemporaryFolder folder;
  session_.sample.clear();
  Surface shape = make_sample("sphere", 24).load(0);
  for (int k = 0; k < 3; ++k) {
    for (Vec3d& p : shape.points) p.z *= 1.05;
    session_.inputs.push_back(folder / ("shape_" + std::to_string(k) + ".vtp"));
    write_surface(session_.inputs.back(), shape);
  }
  session_.settings.vectors = "@swirl";
  open();
  for (const double zoom : {16.0, 20.0}) {
    look(zoom);
    let_pass();
    EXPECT_EQ(scene_->focuses(), 0u);
  }
  EXPECT_EQ(remarks("a close-up is drawn with the texture of the whole"), 1u);
}

}  // namespace
}  // namespace nacre
