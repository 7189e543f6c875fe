// Nacre: the bar under the picture, by mouse and keys. No OpenGL here.
#include "app/viewer/panel/transport_bar.hpp"

#include "tests/app/imgui_frames.hpp"

namespace nacre::test {
namespace {

class TransportBarTest : public ImGuiFrames {
 protected:
  static constexpr int steps = 20;

  void SetUp() override {
    begin(900, 100);
    session_.settings.flow.steps = steps;
    time_.kind = Transport::Kind::time;
    time_.first = 0;
    time_.last = steps - 1;
    time_.shown = 7;
    time_.per_step = 0.05;
    for (int k = 0; k < 2; ++k) frame();
  }
  void draw() override { bar_.draw(session_, time_, {0, 20, 900, TransportBar::height()}); }

  /// The middle of what has this name in the bar, by looking for it from left to right.
  void click_until(const std::function<bool()>& done) {
    for (float x = 4; x < 200 && !done(); x += 8) click(x, 20 + 0.5f * float(TransportBar::height()));
  }
  const ViewSettings& view() const { return session_.settings.view; }
  double begin_at(int position) const { return begin_at_of(position, steps); }

  Session session_;
  Transport time_;
  TransportBar bar_;
};

TEST_F(TransportBarTest, PausingHoldsWhatIsSeen) {
  bar_.toggle_play(session_, time_);
  EXPECT_FALSE(view().play);
  EXPECT_EQ(session_.settings.begin_at, begin_at(7));
  bar_.toggle_play(session_, time_);
  EXPECT_TRUE(view().play);
}

TEST_F(TransportBarTest, StepsGoRoundWhereTimeDoes) {
  session_.settings.view.play = false;
  time_.shown = 0;
  bar_.step(session_, time_, -1);
  EXPECT_EQ(session_.settings.begin_at, begin_at(steps - 1));
  time_.shown = steps - 1;
  bar_.step(session_, time_, 1);
  EXPECT_EQ(session_.settings.begin_at, begin_at(0));
  time_.first = 1, time_.last = time_.shown = steps;  // it does not loop
  bar_.step(session_, time_, 1);
  EXPECT_EQ(session_.settings.begin_at, begin_at(steps));
}

TEST_F(TransportBarTest, AtTheEndPlayBeginsAnew) {
  time_.first = 1, time_.last = time_.shown = steps;
  time_.ended = true;
  session_.settings.begin_at = begin_at(1);
  bar_.toggle_play(session_, time_);
  EXPECT_EQ(session_.settings.begin_at, begin_at(steps)) << "a change, so that the next is one, too";
  frame();
  EXPECT_EQ(session_.settings.begin_at, begin_at(1));
  EXPECT_TRUE(view().play);
}

TEST_F(TransportBarTest, ScrubbingStandsStillAndThenGoesOn) {
  const float y = 20 + 0.5f * float(TransportBar::height());
  move(700, y);
  frame();
  ImGui::GetIO().MouseDown[0] = true;
  frame();
  frame();
  EXPECT_TRUE(bar_.scrubs());
  EXPECT_FALSE(view().play);
  frame();
  const double first = session_.settings.begin_at;
  EXPECT_NE(first, begin_at(7));
  move(600, y);
  frame();
  EXPECT_LT(session_.settings.begin_at, first);
  ImGui::GetIO().MouseDown[0] = false;
  frame();
  EXPECT_FALSE(bar_.scrubs());
  EXPECT_TRUE(view().play);
}

TEST_F(TransportBarTest, ButtonsChangeTheSession) {
  click_until([&] { return !view().play; });
  EXPECT_FALSE(view().play);
  session_.settings.view.play = true;
  click_until([&] { return !view().loop; });
  EXPECT_FALSE(view().loop);
}

TEST_F(TransportBarTest, IterationsOfAMeshAreTheSameBar) {
  time_ = {};
  time_.kind = Transport::Kind::iterations;
  time_.first = 1, time_.last = time_.shown = 40;
  bar_.toggle_play(session_, time_);
  EXPECT_FALSE(view().play);
  EXPECT_EQ(view().iteration, 40);
  bar_.step(session_, time_, -1);
  EXPECT_EQ(view().iteration, 39);
  time_.shown = 40;
  bar_.step(session_, time_, 1);
  EXPECT_EQ(view().iteration, 41) << "one more is made";
  bar_.toggle_play(session_, time_);
  EXPECT_EQ(view().iteration, 0);
}

}  // namespace
}  // namespace nacre::test
