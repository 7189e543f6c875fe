// Nacre: frames of Dear ImGui for tests: mouse and keys without a window. No OpenGL here.
#pragma once

#include <gtest/gtest.h>
#include <imgui.h>

#include <string>

namespace nacre::test {

class ImGuiFrames : public testing::Test {
 protected:
  void begin(float width, float height) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(width, height);
    io.IniFilename = nullptr;
    io.KeyMap[ImGuiKey_Enter] = enter_key;
    io.KeyMap[ImGuiKey_Escape] = escape_key;
    unsigned char* pixels;
    int across, down;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &across, &down);
    move(-1, -1);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  virtual void draw() = 0;
  void frame() {
    ImGui::GetIO().DeltaTime = 0.4f;  // no click is a double click
    ImGui::NewFrame();
    draw();
    over_ = ImGui::IsAnyItemHovered();
    ImGui::EndFrame();
  }

  void move(float x, float y) { ImGui::GetIO().MousePos = ImVec2(x, y); }
  void click(float x, float y) {
    move(x, y);
    for (const bool down : {false, true, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      frame();
    }
  }
  void press(int key) {
    for (const bool down : {true, false}) {
      ImGui::GetIO().KeysDown[key] = down;
      frame();
    }
  }
  void type(const std::string& letters) {
    for (const char letter : letters) {
      ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(letter));
      frame();
    }
  }

  static constexpr int enter_key = 1, escape_key = 2;
  bool over_ = false;  ///< the mouse was over something in the last frame
};

}  // namespace nacre::test
