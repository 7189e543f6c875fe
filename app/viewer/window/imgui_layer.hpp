// Nacre: Dear ImGui, in a window or without one. It is used in this folder only.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/gl/window.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

class ImGuiLayer {
 public:
  explicit ImGuiLayer(Window* window);
  ~ImGuiLayer();
  ImGuiLayer(const ImGuiLayer&) = delete;
  ImGuiLayer& operator=(const ImGuiLayer&) = delete;

  /// Between these two, panels are made and the mouse can be asked for. `seconds`: since the last frame.
  void begin(int width, int height, double seconds, const ViewSettings& view);
  void end();

  /// Keys with ctrl, and Escape, that went down in this frame.
  const std::vector<KeyPress>& chords() const { return chords_; }
  std::array<float, 2> cursor() const;  ///< pixels from the left upper corner

  /// Is the user in the middle of something: pulling a slider, typing?
  static bool busy();

 private:
  void dress(const ViewSettings& view);
  void take_input();

  Window* window_;
  std::array<bool, 3> buttons_{};  ///< of the mouse, down
  std::vector<KeyPress> chords_;
  std::optional<Theme> theme_;
  float size_ = 0;  ///< of the font, pixels
};

}  // namespace nacre
