// Nacre: the window of the keyframes, by mouse and keys. No OpenGL here.
#include "app/viewer/panel/keyframes_window.hpp"

#include <imgui_internal.h>

#include <cmath>

#include "tests/app/imgui_frames.hpp"

namespace nacre::test {
namespace {

Camera camera_from(double x, double y) {
  Camera camera;
  camera.eye = {x, y, 1};
  camera.up = {0, 0, 1};
  return camera;
}
const Camera front_view = camera_from(0, -5), side_view = camera_from(5, 0);

class KeyframesWindowTest : public ImGuiFrames {
 protected:
  void SetUp() override {
    begin(900, 700);
    session_.sample = "torus";
    session_.camera = front_view;
    session_.settings.view.theme = Theme::light;
    window_.toggle();
    for (int k = 0; k < 3; ++k) frame();
  }
  void draw() override {
    const KeyframesWindow::Wish wish = window_.draw(session_, {0, 0, 900, 700}, facts_);
    if (wish.play) played_ = wish.play;
    stopped_ = stopped_ || wish.stop;
    asked_ = asked_ || wish.save || wish.film || wish.open || wish.screenshot;
  }

  const std::vector<SessionEvent>& events() const { return window_.list().events(); }

  static const ImGuiWindow& its() { return *ImGui::FindWindowByName("###keyframes"); }
  static float line() { return ImGui::GetTextLineHeight(); }
  static const ImGuiStyle& style() { return ImGui::GetStyle(); }
  static ImVec2 content() { return its().ContentRegionRect.Min; }

  void click_button(const std::string& name) {
    float x = content().x;
    for (const char* each : {"Add here", "Add after", "Update", "Go to", "Delete"}) {
      const float wide = ImGui::CalcTextSize(each).x + 2 * style().FramePadding.x;
      if (each == name) return click(x + 0.5f * wide, content().y + 0.5f * line());
      x += wide + style().ItemSpacing.x;
    }
  }

  /// Of the axis, which reaches to 1.2 of the duration, or to 4 s.
  float x_of(double time) const {
    const float left = content().x + 2 * 1.25f * (line() + 2 * style().FramePadding.y) + 4.5f * line();
    const float right = its().ContentRegionRect.Max.x, margin = 0.8f * line();
    const double end = std::max(1.2 * window_.list().duration(), 4.0);
    return left + margin + float(time / end) * (right - left - 2 * margin);
  }
  float track_top() const { return content().y + line() + 2 * style().FramePadding.y + style().ItemSpacing.y; }
  float row_y(int row) const {  // the beginning has the row -1
    const float high = line() + 2 * style().FramePadding.y + 2 * style().CellPadding.y;
    const float top = track_top() + KeyframeTrack::height() + style().ItemSpacing.y;
    return top + line() + 2 * style().CellPadding.y + (float(row) + 1.5f) * high;
  }
  void hold(float x, float y) {
    move(x, y);
    frame();
    ImGui::GetIO().MouseDown[0] = true;
    frame();
  }
  void let_go() {
    ImGui::GetIO().MouseDown[0] = false;
    frame();
    frame();
  }

  /// At the front; 2 s later at the side, and then with edges.
  void make_two() {
    click_button("Add here");
    session_.camera = side_view;
    click_button("Add after");
    session_.settings.view.edges = true;
    click_button("Add after");
    ASSERT_EQ(events().size(), 2u);
  }

  Session session_;
  KeyframesWindow window_;
  KeyframesWindow::Facts facts_;
  std::optional<double> played_;
  bool stopped_ = false, asked_ = false;
};

TEST_F(KeyframesWindowTest, AListIsMadeWithItsButtons) {
  EXPECT_FALSE(window_.list().begun());
  make_two();
  EXPECT_EQ(window_.list().recording().camera, front_view);
  EXPECT_EQ(events()[0].camera, side_view);
  EXPECT_EQ(events()[0].over, 2);
  EXPECT_EQ(events()[1].time, 4);
  EXPECT_EQ(events()[1].knobs, (std::map<std::string, std::string>{{"edges", "true"}}));
  session_.settings.legend = false;
  click_button("Update");  // the last one is selected
  EXPECT_EQ(events()[1].knobs.size(), 2u);
  click_button("Delete");
  EXPECT_EQ(events().size(), 1u);
  window_.undo();
  EXPECT_EQ(events().size(), 2u);
  window_.redo();
  EXPECT_EQ(events().size(), 1u);
  EXPECT_TRUE(window_.list().unsaved());
}

TEST_F(KeyframesWindowTest, TheAxisShowsEachTime) {
  make_two();
  hold(x_of(1), track_top() + 0.5f * line());
  frame();
  EXPECT_GT(session_.camera->eye.x, 1);
  EXPECT_LT(session_.camera->eye.x, 4) << "half-way";
  EXPECT_FALSE(session_.settings.view.edges);
  EXPECT_EQ(session_.settings.view.theme, Theme::light) << "the window stays as it is";
  move(x_of(4.5), track_top() + 0.5f * line());
  frame();
  EXPECT_EQ(session_.camera, side_view);
  EXPECT_TRUE(session_.settings.view.edges);
  let_go();
}

TEST_F(KeyframesWindowTest, MarksArePulledToAnotherTime) {
  make_two();
  hold(x_of(4), track_top() + 2.4f * line());
  move(x_of(1), track_top() + 2.4f * line());
  frame();
  EXPECT_EQ(events()[1].time, 4) << "not before it is let go";
  let_go();
  EXPECT_NEAR(events()[0].camera ? events()[1].time : events()[0].time, 1, 0.05);
  EXPECT_EQ(window_.list().duration(), 2);
  window_.undo();
  EXPECT_EQ(events()[1].time, 4) << "one change";
}

TEST_F(KeyframesWindowTest, TimesAreTyped) {
  make_two();
  ImGui::GetIO().KeyCtrl = true;
  click(content().x + 2 * line(), row_y(1));
  ImGui::GetIO().KeyCtrl = false;
  type("7.5");
  press(enter_key);
  frame();
  EXPECT_EQ(events()[1].time, 7.5);
  ImGui::GetIO().KeyCtrl = true;
  click(content().x + 8 * line(), row_y(0));  // "over"
  ImGui::GetIO().KeyCtrl = false;
  type("0.5");
  press(enter_key);
  frame();
  EXPECT_EQ(events()[0].over, 0.5);
}

TEST_F(KeyframesWindowTest, ASelectedOneIsSeen) {
  make_two();
  click(content().x + 18 * line(), row_y(0));
  click_button("Go to");
  EXPECT_EQ(session_.camera, side_view) << "where the camera has arrived";
  EXPECT_FALSE(session_.settings.view.edges);
  click(content().x + 18 * line(), row_y(-1));
  click_button("Go to");
  EXPECT_EQ(session_.camera, front_view);
}

TEST_F(KeyframesWindowTest, ItsContentFits) {
  make_two();
  EXPECT_EQ(its().ScrollMax.y, 0);
  click(content().x + 18 * line(), row_y(1));
  for (int k = 0; k < 4; ++k) frame();
  EXPECT_EQ(its().ScrollMax.y, 0) << "with the knobs of the selected one";
  for (int k = 0; k < 4; ++k) {
    session_.settings.view.edges = !session_.settings.view.edges;
    click_button("Add after");
    for (int f = 0; f < 4; ++f) frame();
    EXPECT_EQ(its().ScrollMax.y, 0) << k << " " << its().ContentSize.y << " " << its().ScrollbarY;
  }
}

TEST_F(KeyframesWindowTest, AListIsPlayedFromTheRedLine) {
  const float high = line() + 2 * style().FramePadding.y;
  const auto press_play = [&] { click(content().x + 1.9f * high, track_top() + 0.5f * KeyframeTrack::height()); };
  press_play();
  EXPECT_FALSE(played_) << "there is nothing to play";
  make_two();
  hold(x_of(1), track_top() + 0.5f * line());
  let_go();
  press_play();
  ASSERT_TRUE(played_);
  EXPECT_NEAR(*played_, 1, 0.05);
  facts_.time = 1.5;
  frame();
  press_play();  // is a stop now
  EXPECT_TRUE(stopped_);
  stopped_ = false;
  click_button("Go to");
  EXPECT_TRUE(stopped_) << "playing would lead away from it";
}

TEST_F(KeyframesWindowTest, ARecordingIsEdited) {
  Session recording = session_;
  recording.sample = "train";
  recording.camera = side_view;
  window_.edit(recording, "a.json", session_);
  EXPECT_EQ(session_.sample, "train");
  EXPECT_EQ(session_.camera, side_view);
  EXPECT_FALSE(window_.list().unsaved());
  window_.toggle();
  frame();
  window_.toggle();
  EXPECT_EQ(window_.list().recording().sample, "train") << "closing keeps the list";
}

TEST_F(KeyframesWindowTest, NothingLiesOverTheVideo) {
  facts_.filming = true;
  for (int k = 0; k < 2; ++k) frame();
  EXPECT_FALSE(its().Active);
  EXPECT_FALSE(window_.has_keys());
}

}  // namespace
}  // namespace nacre::test
