// Nacre: time in the viewer: frames that are shown again, jumps, the end, and iterations that are looked back at.
#include "app/viewer/scene/transport.hpp"

#include <chrono>
#include <functional>

#include "app/viewer/flow/flow_scene.hpp"
#include "app/viewer/mesh/mesh_scene.hpp"
#include "app/viewer/scene/scene_view.hpp"
#include "engine/gl/framebuffer.hpp"
#include "tests/app/viewer/scene_in_view.hpp"

namespace nacre {
namespace {

template <class AnyScene>
class InTime : public test::SceneInView<AnyScene> {
 protected:
  using test::SceneInView<AnyScene>::session_;
  using test::SceneInView<AnyScene>::scene_;

  void advance() { scene_->advance_and_wait(stop_); }
  int shown() const { return scene_->transport().shown; }

  bool comes_about(const std::function<bool()>& what) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    double time = 0;
    while (!what() && std::chrono::steady_clock::now() < end) scene_->advance(time += 1);
    return what();
  }

  std::vector<std::uint8_t> picture() {
    View view = scene_view(session_, scene_->corners(), 0, 96, 96);
    view.camera = fit_camera("iso", scene_->corners(), 96, 96);
    const Framebuffer frame(96, 96);
    frame.bind();
    frame.clear({1, 1, 1, 1});
    scene_->draw(view);
    return frame.read().pixels;
  }

  std::atomic<bool> stop_{false};
};

class FlowInTime : public InTime<FlowScene> {
 protected:
  static constexpr int steps = 6;

  void open() {
    session_.sample = "sphere";
    session_.detail = 24;
    session_.settings.flow.resolution = 48;
    session_.settings.flow.steps = steps;
    scene_ = std::make_unique<FlowScene>(session_, make_cpu_device(2), true);
  }
  void seek(int position) {
    change([&](Settings& s) { s.begin_at = begin_at_of(position, steps); });
  }
  void pause() {
    change([&](Settings& s) { s.view.play = false, s.begin_at = begin_at_of(shown(), steps); });
  }
};

TEST_F(FlowInTime, UndoneKnobsBringTheirFramesBackAtOnce) {
  for (const bool embeds : {false, true}) {
    session_ = Session();
    open();
    std::map<int, std::vector<std::uint8_t>> pictures;
    for (int k = 1; k <= 3; ++k) advance(), pictures[k] = picture();
    const Settings before = session_.settings;
    pause();
    change([&](Settings& s) { embeds ? s.flow.resolution = 32 : s.flow.ttl = 2; });
    change([](Settings& s) { s.view.play = true; });
    for (int k = 0; k < 2; ++k) advance();
    EXPECT_TRUE(picture() != pictures[1] && picture() != pictures[2] && picture() != pictures[3]);
    pause();
    change([&](Settings& s) { s.flow = before.flow; });  // undo
    EXPECT_EQ(shown(), 3);
    EXPECT_EQ(picture(), pictures[3]) << "nothing has been computed yet";
    EXPECT_TRUE(comes_about([&] { return scene_->settled(); }));
    EXPECT_EQ(picture(), pictures[3]) << "what is computed behind it does not change it";
    seek(2);
    EXPECT_EQ(picture(), pictures[2]) << "earlier frames are there, too";
    seek(3);
    change([](Settings& s) { s.view.play = true; });
    advance();
    EXPECT_EQ(shown(), 4) << "and it goes on";
    scene_.reset();
  }
}

TEST_F(FlowInTime, AShownTimeComesBackAsItWasAndWithoutComputing) {
  open();
  std::map<int, std::vector<std::uint8_t>> pictures;
  for (int k = 1; k <= 4; ++k) {
    advance();
    EXPECT_EQ(shown(), k);
    pictures[k] = picture();
  }
  EXPECT_NE(pictures[2], pictures[3]);
  pause();
  EXPECT_EQ(shown(), 4);
  for (const int back : {3, 1, 2}) {
    seek(back);
    EXPECT_EQ(shown(), back);
    EXPECT_EQ(picture(), pictures[back]);
    EXPECT_DOUBLE_EQ(scene_->results().time, scene_->transport().time_of(back));
    EXPECT_TRUE(comes_about([&] { return scene_->settled(); }));
    EXPECT_EQ(shown(), back) << "nothing is computed for it";
  }
  EXPECT_EQ(scene_->steps(), 4);
  change([](Settings& s) { s.view.play = true; });
  for (const int on : {3, 4}) {
    advance();
    EXPECT_EQ(shown(), on);
    EXPECT_EQ(picture(), pictures[on]);
    EXPECT_EQ(scene_->steps(), 4);
  }
  advance();  // and here the worker goes on
  EXPECT_EQ(shown(), 5);
  EXPECT_EQ(scene_->steps(), 5);
}

TEST_F(FlowInTime, AStepForthIsOneStep) {
  open();
  advance();
  advance();
  pause();
  seek(3);
  advance();
  EXPECT_EQ(shown(), 3);
  EXPECT_EQ(scene_->steps(), 3) << "one more, not from the noise";
  EXPECT_TRUE(comes_about([&] { return scene_->settled(); }));
  EXPECT_EQ(scene_->steps(), 3);
}

TEST_F(FlowInTime, AJumpShowsItsColoursBeforeItsTexture) {
  open();
  advance();
  pause();
  const auto before = picture();
  seek(4);
  EXPECT_EQ(shown(), 4);
  EXPECT_TRUE(scene_->transport().warming);
  const double wanted = scene_->transport().time_of(4);
  ASSERT_TRUE(comes_about([&] { return scene_->results().time == wanted; }));
  ASSERT_TRUE(comes_about([&] { return !scene_->transport().warming && scene_->settled(); }));
  EXPECT_EQ(shown(), 4);
  EXPECT_NE(picture(), before);
  EXPECT_TRUE(scene_->transport().is_warm(1)) << "what was shown is still at hand";
  EXPECT_TRUE(scene_->transport().is_warm(4));
  EXPECT_FALSE(scene_->transport().is_warm(3));
}

TEST_F(FlowInTime, WhereItDoesNotLoopItStopsAtTheLastTimeOfTheData) {
  session_.settings.view.loop = false;
  open();
  for (int k = 1; k <= steps + 3; ++k) advance();
  const Transport t = scene_->transport();
  EXPECT_TRUE(t.ended);
  EXPECT_EQ(t.shown, steps);
  EXPECT_DOUBLE_EQ(scene_->results().time, scene_->results().data.time.high);
  EXPECT_TRUE(comes_about([&] { return scene_->settled(); }));
  EXPECT_EQ(scene_->steps(), steps);
}

TEST_F(FlowInTime, WhereItLoopsTheFirstTimeComesAfterTheLast) {
  open();
  std::vector<int> positions;
  for (int k = 1; k <= steps + 1; ++k) advance(), positions.push_back(shown());
  EXPECT_EQ(positions, (std::vector<int>{1, 2, 3, 4, 5, 0, 1}));
  seek(0);
  EXPECT_EQ(shown(), 0);
  EXPECT_FALSE(scene_->transport().warming);
}

TEST_F(FlowInTime, AnotherTextureIsNotMixedWithFramesOfTheOld) {
  open();
  advance();
  advance();
  change([](Settings& s) { s.flow.contrast = 0.2; });
  EXPECT_FALSE(scene_->transport().is_warm(1));
  advance();
  EXPECT_TRUE(scene_->transport().is_warm(3));
}

class MeshInTime : public InTime<MeshScene> {
 protected:
  void open(bool lockstep) {
    session_.sample = "two-spheres";
    session_.detail = 20;
    session_.settings.mesh.iterations = 20;
    session_.settings.mesh.remesh = 0;
    SceneOptions options;
    options.open_device = [] { return make_cpu_device(2); };
    options.lockstep = lockstep;
    scene_ = std::make_unique<MeshScene>(session_, options);
  }
};

TEST_F(MeshInTime, EarlierIterationsComeBackAsTheyWere) {
  open(true);
  std::map<int, std::vector<std::uint8_t>> pictures;
  for (int k = 1; k <= 12; ++k) advance(), pictures[k] = picture();
  EXPECT_EQ(shown(), 12);
  for (const int back : {11, 3, 7}) {
    change([&](Settings& s) { s.view.iteration = back; });
    EXPECT_EQ(shown(), back);
    EXPECT_EQ(picture(), pictures[back]);
  }
  EXPECT_NE(pictures[3], pictures[11]);
  change([](Settings& s) { s.view.iteration = 0; });
  EXPECT_EQ(picture(), pictures[12]);
}

TEST_F(MeshInTime, ItPausesBetweenTwoIterations) {
  session_.settings.view.play = false;
  open(false);
  ASSERT_TRUE(comes_about([&] { return scene_->settled(); }));
  EXPECT_EQ(scene_->steps(), 0);
  EXPECT_EQ(scene_->progress().stage, "");
  change([](Settings& s) { s.view.iteration = 2; });
  ASSERT_TRUE(comes_about([&] { return scene_->steps() == 2 && scene_->settled(); }));
  EXPECT_EQ(shown(), 2);
  change([](Settings& s) { s.view.play = true, s.view.iteration = 0; });
  ASSERT_TRUE(comes_about([&] { return scene_->transport().ended; }));
  EXPECT_GT(scene_->steps(), 2);
}

}  // namespace
}  // namespace nacre
