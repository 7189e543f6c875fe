// Nacre: tests of a second scene beside the first: opened, changed and closed with it, and at the same time.
#include "app/viewer/window/comparison.hpp"

#include <chrono>
#include <functional>
#include <thread>

#include "app/viewer/flow/flow_scene.hpp"
#include "compute/device/error.hpp"
#include "tests/app/viewer/scene_in_view.hpp"

namespace nacre {
namespace {

Transport flow_at(int shown, int first, int last) {
  Transport t;
  t.kind = Transport::Kind::time;
  t.first = first;
  t.last = last;
  t.shown = shown;
  return t;
}

TEST(StepsAhead, CountsRoundTheEndOfALoop) {
  EXPECT_EQ(steps_ahead(flow_at(5, 0, 19), flow_at(5, 0, 19)), 0);
  EXPECT_EQ(steps_ahead(flow_at(6, 0, 19), flow_at(5, 0, 19)), 1);
  EXPECT_EQ(steps_ahead(flow_at(5, 0, 19), flow_at(6, 0, 19)), -1);
  EXPECT_EQ(steps_ahead(flow_at(0, 0, 19), flow_at(19, 0, 19)), 1);
  EXPECT_EQ(steps_ahead(flow_at(19, 0, 19), flow_at(0, 0, 19)), -1);
}

TEST(StepsAhead, WithoutALoopTheEndIsTheEnd) { EXPECT_EQ(steps_ahead(flow_at(1, 1, 20), flow_at(20, 1, 20)), -19); }

TEST(StepsAhead, DifferentTimesAreNotCompared) {
  EXPECT_EQ(steps_ahead(flow_at(6, 0, 19), flow_at(5, 0, 29)), 0);
  EXPECT_EQ(steps_ahead(flow_at(-1, 0, 19), flow_at(5, 0, 19)), 0);
  EXPECT_EQ(steps_ahead(Transport(), flow_at(5, 0, 19)), 0);
  Transport later = flow_at(5, 0, 19);
  later.start = 3;
  EXPECT_EQ(steps_ahead(flow_at(6, 0, 19), later), 0);
}

TEST(Halves, ShareTheAreaWithAGap) {
  const auto [left, right] = halves({10, 20, 301, 100});
  EXPECT_EQ(left.width, right.width);
  EXPECT_EQ(left.x, 10);
  EXPECT_EQ(right.x + right.width, 311);
  EXPECT_GT(right.x, left.x + left.width);
  EXPECT_EQ(left.height, 100);
  EXPECT_EQ(left.y, 20);
}

class ComparisonInView : public test::SceneInView<FlowScene> {
 protected:
  void SetUp() override {
    SceneInView::SetUp();
    session_.sample = "sphere";
    session_.detail = 24;
    session_.settings.flow.resolution = 48;
    session_.settings.flow.steps = 6;
    session_.settings.view.compare = compare_same;
    session_.settings.focus = false;
  }

  void TearDown() override {
    comparison_.close();
    SceneInView::TearDown();
  }

  SceneOptions options() {
    SceneOptions options;
    options.open_device = [] { return make_cpu_device(2); };
    return options;
  }

  void open() {
    scene_ = std::make_unique<FlowScene>(session_, make_cpu_device(2), true);
    comparison_.follow(session_, *scene_, options());
  }

  void frame() {
    scene_->advance_and_wait(stop_);
    comparison_.advance_and_wait(*scene_, stop_);
  }

  /// As the loop ends a frame; the workers need the processors.
  static void end_frame() {
    glFinish();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  int ahead() { return steps_ahead(scene_->transport(), comparison_.scene().transport()); }

  Comparison comparison_;
  std::atomic<bool> stop_{false};
};

TEST_F(ComparisonInView, OneThatStartsAgainCatchesUpWithinAFrame) {
  open();
  for (int k = 0; k < 3; ++k) frame();
  EXPECT_EQ(ahead(), 0);
  session_.settings.view.compare_knobs = "ttl=9";
  comparison_.follow(session_, *scene_, options());
  frame();
  EXPECT_EQ(ahead(), 0);
  EXPECT_EQ(scene_->steps(), 4) << "the first scene goes on";
  for (int k = 0; k < 6; ++k) {  // beyond the end of the loop
    frame();
    EXPECT_EQ(ahead(), 0);
  }
}

TEST_F(ComparisonInView, InAWindowNoneIsMoreThanAStepAhead) {
  open();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  double now = 0;
  bool together = false;  // one may begin before the other, by more than a loop
  int behind = 0;         // then
  const auto steps_of_second = [&] { return static_cast<FlowScene&>(comparison_.scene()).steps(); };
  while ((!together || scene_->steps() < 20) && std::chrono::steady_clock::now() < end) {
    now += 10;  // the pace allows a step in each frame
    comparison_.advance(*scene_, now);
    scene_->advance(now);
    const bool both = scene_->transport().shown >= 0 && comparison_.scene().transport().shown >= 0;
    if (!together && both && ahead() == 0) {
      together = true;
      behind = scene_->steps() - steps_of_second();
    }
    if (together) {
      ASSERT_LE(std::abs(ahead()), 1);
    }
    end_frame();
  }
  EXPECT_TRUE(together);
  EXPECT_GE(scene_->steps(), 20);
  EXPECT_GE(steps_of_second() + behind, 19);
}

TEST_F(ComparisonInView, ItIsOpenedAtTheTimeThatIsShown) {
  session_.settings.view.compare.clear();
  open();
  for (int k = 0; k < 4; ++k) scene_->advance_and_wait(stop_);
  session_.settings.view.compare = compare_same;
  comparison_.follow(session_, *scene_, options());
  comparison_.scene().advance_and_wait(stop_, endless);
  EXPECT_EQ(ahead(), 0);
  EXPECT_EQ(static_cast<FlowScene&>(comparison_.scene()).steps(), 1);
}

TEST_F(ComparisonInView, PausedTheyComeToTheSameTime) {
  open();
  double now = 0;
  const auto go_on_until = [&](const std::function<bool()>& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done() && std::chrono::steady_clock::now() < end) {
      now += 10;
      comparison_.advance(*scene_, now);
      scene_->advance(now);
      end_frame();
    }
    return done();
  };
  ASSERT_TRUE(go_on_until([&] { return scene_->steps() >= 3 && ahead() != 0; }));
  change([](Settings& settings) { settings.view.play = false; });
  comparison_.follow(session_, *scene_, options());
  EXPECT_TRUE(go_on_until([&] { return scene_->settled() && comparison_.scene().settled(); }));
  EXPECT_EQ(ahead(), 0);
}

TEST_F(ComparisonInView, KnobsOfTheFirstAreThoseOfTheSecondUnlessTheyDiffer) {
  session_.settings.view.compare_knobs = "ttl=9";
  open();
  const Scene* const second = &comparison_.scene();
  frame();
  change([](Settings& settings) { settings.colormap = "ember"; });
  comparison_.follow(session_, *scene_, options());
  EXPECT_EQ(&comparison_.scene(), second) << "changed, not opened again";
  session_.settings.view.compare = "sample:torus:24";
  comparison_.follow(session_, *scene_, options());
  frame();
  EXPECT_EQ(comparison_.scene().title().substr(0, 5), "torus");
  session_.settings.view.compare.clear();
  comparison_.follow(session_, *scene_, options());
  EXPECT_FALSE(comparison_.on());
}

TEST_F(ComparisonInView, WhatMeansNothingLeavesTheSecondAsItWas) {
  open();
  frame();
  session_.settings.view.compare_knobs = "ttl=never";
  EXPECT_THROW(comparison_.follow(session_, *scene_, options()), Error);
  ASSERT_TRUE(comparison_.on());
  frame();
  EXPECT_EQ(ahead(), 0);
}

}  // namespace
}  // namespace nacre
