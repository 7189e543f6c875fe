// Nacre: knobs of the panel, turned with the mouse. No OpenGL here.
#include "app/viewer/panel/knob_widgets.hpp"

#include <gtest/gtest.h>
#include <imgui.h>

#include "app/viewer/scene/view_defaults.hpp"

namespace nacre {
namespace {

class KnobWidgets : public testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(400, 100);
    io.DeltaTime = 0.1f;
    io.IniFilename = nullptr;
    unsigned char* pixels;
    int across, down;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &across, &down);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  void frame(const char* knob, float x, int button = -1) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = ImVec2(x, 18);
    for (int k = 0; k < 2; ++k) io.MouseDown[k] = k == button;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(400, 100));
    ImGui::Begin("knobs", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    knob_widget(settings_, knob);
    ImGui::End();
    ImGui::EndFrame();
  }

  /// Takes the slider at its left end and lets it go at the right one, or the other way round.
  void drag(const char* knob, float from, float to) {
    frame(knob, from);
    frame(knob, from);  // windows are where they are from the second frame on
    frame(knob, from, 0);
    frame(knob, to, 0);
    frame(knob, to);
    frame(knob, to);
  }

  static constexpr float left = 12, right = 196;
  Settings settings_;
};

TEST_F(KnobWidgets, ASliderTurnsItsKnob) {
  drag("epsilon", right, left);
  EXPECT_DOUBLE_EQ(settings_.mesh.epsilon, 0.01);
  drag("epsilon", left, right);
  EXPECT_DOUBLE_EQ(settings_.mesh.epsilon, 100);
}

TEST_F(KnobWidgets, ANumberIsTakenWhenItIsLetGo) {
  const std::uint32_t before = settings_.flow.seed;
  for (const int button : {-1, -1, 0, -1}) frame("seed", left, button);
  ImGui::GetIO().AddInputCharacter('7');
  for (int k = 0; k < 2; ++k) frame("seed", left);
  EXPECT_EQ(settings_.flow.seed, before);
  for (const int button : {0, -1, -1}) frame("seed", 390, button);  // elsewhere
  EXPECT_NE(settings_.flow.seed, before);
  EXPECT_EQ(settings_.mesh.seed, settings_.flow.seed);
}

TEST_F(KnobWidgets, SizesDoNotPassEachOther) {
  drag("min_size", left, right);
  EXPECT_DOUBLE_EQ(settings_.mesh.min_size, Settings().mesh.max_size);
  settings_.mesh.max_size = 5;
  drag("min_size", left, right);
  EXPECT_DOUBLE_EQ(settings_.mesh.min_size, 5);
  drag("max_size", right, left);
  EXPECT_DOUBLE_EQ(settings_.mesh.max_size, 5);
}

TEST_F(KnobWidgets, AResetStopsThereToo) {
  settings_.mesh.max_size = 5;
  settings_.mesh.min_size = 3;
  for (const int button : {-1, -1, 1, -1}) frame("max_size", 230, button);  // its name, to the right of the slider
  EXPECT_DOUBLE_EQ(settings_.mesh.max_size, 3) << "1, if it could";
}

TEST_F(KnobWidgets, ResetGivesWhatTheViewerBeganWith) {
  settings_ = view_defaults();
  settings_.flow.resolution = 100;
  settings_.flow.ttl = 9;
  reset_knobs(settings_, "flow");
  EXPECT_EQ(settings_.flow.resolution, view_defaults().flow.resolution);
  EXPECT_NE(settings_.flow.resolution, Settings().flow.resolution) << "which other commands begin with";
  EXPECT_EQ(settings_.flow.ttl, Settings().flow.ttl);
}

}  // namespace
}  // namespace nacre
