// Nacre: menus and panel of the viewer, by mouse and keys. No OpenGL here.
#if NACRE_HAS_VIEWER

#include "app/viewer/panel/ui.hpp"

#include "app/viewer/panel/frame_clock.hpp"
#include "tests/app/imgui_frames.hpp"
#include "tests/app/still_scene.hpp"

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
    const UiFacts facts{panel_,
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

  const std::string& tab() const { return session_.settings.look.tab; }

  StillScene scene_{{-1, -1, -1}, {1, 1, 1}};
  EmptyPanel panel_;
  FrameClock clock_;
  std::vector<std::filesystem::path> recent_;
  Session session_;
  Ui ui_;
  std::vector<KeyPress> keys_;
  bool cancelled_ = false;
};

TEST_F(UiTest, AFailureDoesNotMoveTheTabs) {
  float y = 20;
  for (; y < height && tab() != "knobs"; y += 4) click(70, y);
  ASSERT_EQ(tab(), "knobs");
  y -= 4;
  session_.settings.look.tab = "data";
  frame();
  frame();
  scene_.what_failed = "a volume that cannot be read (it is shorter than its header says); give the whole file";
  frame();
  frame();
  click(70, y);
  EXPECT_EQ(tab(), "knobs");
}

}  // namespace
}  // namespace nacre::test

#endif
