// Nacre: Dear ImGui, in a window or without one.
#include "app/viewer/interface.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>

#include "engine/picture/text.hpp"

namespace nacre {

Interface::Interface(Window* window) : window_(window) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no file beside the user's data
  io.LogFilename = nullptr;
  if (window_) ImGui_ImplGlfw_InitForOpenGL(window_->handle(), true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Interface::~Interface() {
  ImGui_ImplOpenGL3_Shutdown();
  if (window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

/// Colours and lettering; made anew where they have changed.
void Interface::dress(const Look& look) {
  const float scale = (window_ ? window_->scale() : 1) * float(look.text_size);
  const float size = std::round(14 * scale);
  if (look.theme == theme_ && size == size_) return;
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  if (look.theme == "light")
    ImGui::StyleColorsLight();
  else
    ImGui::StyleColorsDark();
  style.WindowRounding = style.FrameRounding = style.PopupRounding = style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg].w = 0.9f;
  style.ScaleAllSizes(scale);
  if (size != size_) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    const std::string_view font = font_bytes();
    if (font.empty())
      fonts.AddFontDefault();
    else
      fonts.AddFontFromMemoryTTF(const_cast<char*>(font.data()), int(font.size()), size, &config);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  theme_ = look.theme;
  size_ = size;
}

/// Dear ImGui sees which keys are down when a frame begins. One that came and went in a long frame is held for the next.
void Interface::hold_keys() {
  ImGuiIO& io = ImGui::GetIO();
  for (const int key : held_) io.KeysDown[key] = glfwGetKey(window_->handle(), key) == GLFW_PRESS;
  held_ = window_->take_pressed();
  for (const int key : held_) io.KeysDown[key] = true;
}

void Interface::begin(int width, int height, double seconds, const Look& look) {
  ImGui_ImplOpenGL3_NewFrame();
  dress(look);
  if (window_) {
    ImGui_ImplGlfw_NewFrame();
    hold_keys();
  } else {
    ImGui::GetIO().DisplaySize = ImVec2(float(width), float(height));
    ImGui::GetIO().DeltaTime = float(std::max(seconds, 1e-4));
  }
  ImGui::NewFrame();
}

void Interface::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Interface::busy() { return ImGui::IsAnyItemActive(); }

}  // namespace nacre
