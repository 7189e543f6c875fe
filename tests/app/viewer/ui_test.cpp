// Nacre: menus and panel of the viewer, by mouse and keys. No OpenGL here.

#include "app/viewer/panel/ui.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "app/viewer/panel/frame_clock.hpp"
#include "app/viewer/scene/scene_painter.hpp"
#include "tests/app/imgui_frames.hpp"
#include "tests/app/viewer/still_scene.hpp"

namespace nacre::test {
namespace {

class EmptyPanel : public ScenePanel {
 public:
  void data_tab(Session&) override {}
  void look_tab(Session&) override {}
  void result_tab(Session&) override {}
};

class UiTest : public ImGuiFrames {
 protected:
  static constexpr int width = 800, height = 600;

  void SetUp() override {
    begin(width, height);
    session_.sample = "sphere";
    for (int k = 0; k < 3; ++k) frame();  // sizes are known from the second one on
  }

  void draw() override {
    const UiFacts facts{
        panel_,
        {scene_, areas_of(scene_, session_.settings.view, ui_.free_area(session_.settings.view, width, height))},
        scene_.progress(),
        clock_,
        "renderer",
        recent_,
        false,
        false,
        false,
        "",
        "",
        width,
        height,
        Camera(),
        std::exchange(keys_, {})};
    const UiRequests requests = ui_.draw(session_, scene_, facts);
    cancelled_ = cancelled_ || requests.cancel;
  }

  /// As the window tells it: to the menus and to Dear ImGui.
  void escape() {
    keys_ = {{27, false, false}};
    press(ImGuiFrames::escape_key);
    frame();
  }

  static bool shows(const char* window) {
    const ImGuiWindow* found = ImGui::FindWindowByName(window);
    return found && found->Active;
  }

  PanelTab tab() const { return session_.settings.view.tab; }

  StillScene scene_{{-1, -1, -1}, {1, 1, 1}};
  EmptyPanel panel_;
  FrameClock clock_;
  std::vector<RecentFile> recent_;
  Session session_;
  Ui ui_;
  std::vector<KeyPress> keys_;
  bool cancelled_ = false;
};

TEST_F(UiTest, AFailureDoesNotMoveTheTabs) {
  float y = 20;
  for (; y < height && tab() != PanelTab::knobs; y += 4) click(70, y);
  ASSERT_EQ(tab(), PanelTab::knobs);
  y -= 4;
  session_.settings.view.tab = PanelTab::data;
  frame();
  frame();
  scene_.what_failed = "a volume that cannot be read (it is shorter than its header says); give the whole file";
  frame();
  frame();
  click(70, y);
  EXPECT_EQ(tab(), PanelTab::knobs);
}

TEST_F(UiTest, EscapeClosesWhatIsOpenBeforeItCancels) {
  scene_.doing = {"relax 4", 0.4};
  ui_.show_error("a file could not be written");
  click(12, 8);  // the menu "File"
  ASSERT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
  escape();
  EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) << "first the menu";
  keys_ = {{'O', true, false}};
  frame();
  frame();
  ASSERT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
  escape();
  EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) << "then the dialog";
  EXPECT_TRUE(shows("this did not work"));
  escape();
  EXPECT_FALSE(shows("this did not work")) << "then the error";
  EXPECT_FALSE(cancelled_);
  escape();
  EXPECT_TRUE(cancelled_);
}

TEST_F(UiTest, TheRulerTakesPointsUnderTheMouse) {
  session_.camera = Camera();
  move(600, 300);  // over the view
  frame();
  frame();
  type("d");
  EXPECT_EQ(session_.settings.view.ruler, "") << "there is nothing under the mouse";
  for (const Vec3d& point : {Vec3d(0, 0, 0), Vec3d(2, 0, 0), Vec3d(2, 2, 0)}) {
    scene_.under_the_mouse = point;
    type("d");
  }
  EXPECT_EQ(session_.settings.view.ruler, "0 0 0;2 0 0;2 2 0");
  type("d");  // starts over
  EXPECT_EQ(session_.settings.view.ruler, "2 2 0");
}

TEST_F(UiTest, DyeAndGraphsComeToThePointUnderTheMouse) {
  session_.camera = Camera();
  scene_.set({0, 0, 0}, {10, 0, 0});
  scene_.under_the_mouse = Vec3d(1, 2, 3);
  move(600, 300);
  frame();
  frame();
  type("r");
  type("g");
  EXPECT_EQ(session_.settings.dye + session_.settings.probe, "") << "not in a mesh";
  scene_.flow = true;
  type("r");
  EXPECT_EQ(session_.settings.dye, "1,2,3,0.15");
  type("r");
  type("R");
  EXPECT_EQ(session_.settings.dye, "1,2,3,0.15;1,2,3,0.15|1,2,3,0.15");
  for (int k = 0; k < 3; ++k) type("R");
  EXPECT_EQ(std::count(session_.settings.dye.begin(), session_.settings.dye.end(), '|'), 3) << "there are four colours";
  type("g");
  scene_.under_the_mouse = Vec3d(4, 5, 6);
  type("g");
  EXPECT_EQ(session_.settings.probe, "1,2,3;4,5,6");
}

TEST_F(UiTest, ANoteIsTypedAtThePointUnderTheMouse) {
  session_.camera = Camera();
  scene_.under_the_mouse = Vec3d(1, 2, 3);
  move(600, 300);
  frame();
  frame();
  type("n");
  for (int k = 0; k < 3; ++k) frame();  // the field takes the keys
  for (const char letter : std::string("wake")) type(std::string(1, letter));
  press(enter_key);
  frame();
  EXPECT_EQ(session_.settings.view.notes, "1 2 3 wake");
}

TEST_F(UiTest, DigitsGoBackToCamerasThatWereKept) {
  session_.camera = Camera();
  session_.settings.view.cameras = "a:0 0 5 0 0 0 0 1 0 2;b:7 0 0 0 0 0 0 0 1 3";
  move(600, 300);
  frame();
  frame();
  type("2");
  EXPECT_EQ(session_.camera->eye, Vec3d(7, 0, 0));
  type("1");
  EXPECT_EQ(session_.camera->eye, Vec3d(0, 0, 5));
  type("9");
  EXPECT_EQ(session_.camera->eye, Vec3d(0, 0, 5));
}

TEST_F(UiTest, ThePanelStandsOnEitherSideAndIsPulledWider) {
  const FreeArea left = ui_.free_area(session_.settings.view, width, height);
  session_.settings.view.panel_side = PanelSide::right;
  const FreeArea right = ui_.free_area(session_.settings.view, width, height);
  EXPECT_GT(left.x, 200);
  EXPECT_EQ(right.x, 0);
  EXPECT_EQ(right.width, left.width);
  for (int k = 0; k < 3; ++k) frame();
  move(float(right.width), 300);  // the border
  for (int k = 0; k < 2; ++k) frame();
  ImGui::GetIO().MouseDown[0] = true;
  frame();
  move(float(right.width) - 40, 300);
  frame();
  ImGui::GetIO().MouseDown[0] = false;
  frame();
  EXPECT_GT(session_.settings.view.panel_width, 1.05);
  EXPECT_LT(ui_.free_area(session_.settings.view, width, height).width, right.width);
}

TEST_F(UiTest, ItAsksBeforeItQuits) {
  ui_.ask_quit({"A video is being recorded."});
  frame();
  frame();
  EXPECT_TRUE(ui_.asks_quit());
  escape();
  frame();
  EXPECT_FALSE(ui_.asks_quit()) << "it stays";
  EXPECT_FALSE(cancelled_);
}

TEST_F(UiTest, TheKeyframesTakeBackTheirOwnChanges) {
  type("k");
  for (int k = 0; k < 2; ++k) frame();
  ASSERT_TRUE(shows("###keyframes"));
  ui_.keyframes().edit(session_, "a.json", session_);
  ui_.keyframes().add_screenshot({"/a.png", 1, false, false});
  const KeyframesWindow& keyframes = ui_.keyframes();
  ASSERT_TRUE(keyframes.has_keys());
  keys_ = {{'Z', true, false}};
  frame();
  EXPECT_TRUE(keyframes.list().events().empty());
  keys_ = {{'Y', true, false}};
  frame();
  EXPECT_EQ(keyframes.list().events().size(), 1u);
  click(600, 30);  // on the picture
  keys_ = {{'Z', true, false}};
  frame();
  EXPECT_EQ(keyframes.list().events().size(), 1u) << "that was a knob";
  type("k");
  frame();
  EXPECT_FALSE(shows("###keyframes"));
}

TEST_F(UiTest, LettersAfterAFieldAreNoShortcutsUntilTheMouseIsOverTheView) {
  session_.settings.view.tab = PanelTab::knobs;
  for (int k = 0; k < 3; ++k) frame();
  float y = 20;
  const auto over_field = [&] { return ImGui::GetMouseCursor() == ImGuiMouseCursor_TextInput; };
  for (; y < height && !over_field(); y += 4) move(30, y), frame();
  ASSERT_LT(y, height);
  click(30, y - 4);
  type("t");
  press(enter_key);  // the field is left
  frame();
  const Theme theme = session_.settings.view.theme;
  type("t");
  EXPECT_EQ(session_.settings.view.theme, theme);
  move(600, 300);  // over the view
  frame();
  frame();
  type("t");
  EXPECT_NE(session_.settings.view.theme, theme);
}

}  // namespace
}  // namespace nacre::test
