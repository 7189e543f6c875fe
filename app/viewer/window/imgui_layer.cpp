// Nacre: Dear ImGui, in a window or without one.
#include "app/viewer/window/imgui_layer.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>

#include "engine/picture/text.hpp"

namespace nacre {

ImGuiLayer::ImGuiLayer(Window* window) : window_(window) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no file beside the user's data
  io.LogFilename = nullptr;
  if (window_) ImGui_ImplGlfw_InitForOpenGL(window_->handle(), false);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

ImGuiLayer::~ImGuiLayer() {
  ImGui_ImplOpenGL3_Shutdown();
  if (window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

/// Colours and lettering; made again where they have changed.
void ImGuiLayer::dress(const ViewSettings& view) {
  const float scale = (window_ ? window_->scale() : 1) * float(view.text_size);
  const float size = std::round(14 * scale);
  if (view.theme == theme_ && size == size_) return;
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  if (view.theme == Theme::light)
    ImGui::StyleColorsLight();
  else
    ImGui::StyleColorsDark();
  style.WindowRounding = style.FrameRounding = style.PopupRounding = style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg].w = 0.9f;
  style.Colors[ImGuiCol_PopupBg] = style.Colors[ImGuiCol_WindowBg];  // the light one is as white as its check boxes
  style.Colors[ImGuiCol_PopupBg].w = 1;  // dialogs lie over panels, whose text would show through
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
  theme_ = view.theme;
  size_ = size;
}

std::array<float, 2> ImGuiLayer::cursor() const {
  const ImVec2& at = ImGui::GetIO().MousePos;
  return {at.x, at.y};
}

/// Replaces what the backend polls: a user may do more in a frame than can be polled at its end.
void ImGuiLayer::take_input() {
  const InputFrame input = window_->next_input();
  ImGuiIO& io = ImGui::GetIO();
  for (const auto& [key, down] : input.keys) io.KeysDown[key] = down;
  const auto either = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
  io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
  io.KeySuper = either(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
  for (const auto& [button, down] : input.buttons)
    if (button < int(buttons_.size())) buttons_[std::size_t(button)] = down;
  for (std::size_t k = 0; k < buttons_.size(); ++k) io.MouseDown[k] = buttons_[k];
  io.MousePos = ImVec2(float(input.x), float(input.y));
  io.MouseWheelH += float(input.wheel_x);
  io.MouseWheel += float(input.wheel_y);
  for (const char32_t letter : input.text) io.AddInputCharacter(letter);
  chords_ = input.chords;
}

void ImGuiLayer::begin(int width, int height, double seconds, const ViewSettings& view) {
  ImGui_ImplOpenGL3_NewFrame();
  dress(view);
  ImGuiIO& io = ImGui::GetIO();
  if (window_) {
    ImGui_ImplGlfw_NewFrame();
    take_input();
  } else {
    io.DeltaTime = float(std::max(seconds, 1e-4));
  }
  io.DisplaySize = ImVec2(float(width), float(height));  // all is in pixels, whatever the desktop's units are
  io.DisplayFramebufferScale = ImVec2(1, 1);
  ImGui::NewFrame();
}

void ImGuiLayer::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool ImGuiLayer::busy() { return ImGui::IsAnyItemActive(); }

}  // namespace nacre
