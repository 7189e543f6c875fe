// Nacre: the colour legend in the picture, by mouse. No OpenGL here.
#include "app/viewer/panel/legend_mouse.hpp"

#include "engine/picture/legend.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "tests/app/imgui_frames.hpp"

namespace nacre::test {
namespace {

TEST(PulledRange, AnEndOrBoth) {
  const LegendRange range{10, 20, false};
  const LegendRange top = pulled_range(range, 0.1, 0.2), bottom = pulled_range(range, 0.9, 0.2),
                    both = pulled_range(range, 0.5, 0.2);
  EXPECT_DOUBLE_EQ(top.low, 10);
  EXPECT_DOUBLE_EQ(top.high, 18);
  EXPECT_DOUBLE_EQ(bottom.low, 8);
  EXPECT_DOUBLE_EQ(bottom.high, 20);
  EXPECT_DOUBLE_EQ(both.low, 8);
  EXPECT_DOUBLE_EQ(both.high, 18);
}

TEST(PulledRange, EndsDoNotMeet) {
  EXPECT_GT(pulled_range({10, 20, false}, 0.1, 5).high, 10);
  EXPECT_LT(pulled_range({10, 20, false}, 0.9, -5).low, 20);
}

TEST(PulledRange, ALogarithmIsPulledByFactors) {
  const LegendRange range = pulled_range({1, 100, true}, 0.5, -0.5);
  EXPECT_NEAR(range.low, 10, 1e-9);
  EXPECT_NEAR(range.high, 1000, 1e-9);
}

class LegendMouseTest : public ImGuiFrames {
 protected:
  static constexpr int width = 800, height = 600;
  void SetUp() override {
    begin(width, height);
    for (int k = 0; k < 3; ++k) frame();
  }
  void draw() override { mouse_.draw(settings_, range_, {0, 0, width, height}); }
  /// Of the legend, from its upper end.
  static float at(double share) {
    const KeptFree room = legend_room(width, height);
    return float(height * (room.top + share * (room.bottom - room.top)));
  }

  Settings settings_;
  LegendRange range_{0, 8, false};
  LegendMouse mouse_;
};

TEST_F(LegendMouseTest, ADragUpwardsAtTheTopLowersTheUpperEndAndARightClickGivesTheDataBack) {
  const float x = width - 30;
  move(x, at(0.3));
  frame();
  ImGui::GetIO().MouseDown[0] = true;
  frame();
  move(x, at(0.05));
  frame();
  ImGui::GetIO().MouseDown[0] = false;
  frame();
  EXPECT_EQ(settings_.color_range.substr(0, 3), "0:6");
  ImGui::GetIO().MouseDown[1] = true;
  frame();
  ImGui::GetIO().MouseDown[1] = false;
  frame();
  EXPECT_EQ(settings_.color_range, "");
}

TEST_F(LegendMouseTest, ElsewhereTheMouseIsTheCameras) {
  click(200, 300);
  EXPECT_FALSE(over_);
  EXPECT_EQ(settings_.color_range, "");
}

}  // namespace
}  // namespace nacre::test
