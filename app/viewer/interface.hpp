// Nacre: Dear ImGui, in a window or without one. It is used in this folder only.
#pragma once

#include <string>
#include <vector>

#include "engine/gl/window.hpp"
#include "engine/scene/settings.hpp"

namespace nacre {

class Interface {
 public:
  explicit Interface(Window* window);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Between these two, panels are made and the mouse can be asked for. `seconds`: since the last frame.
  void begin(int width, int height, double seconds, const Look& look);
  void end();

  /// Is the user in the middle of something: pulling a slider, typing?
  static bool busy();

 private:
  void dress(const Look& look);
  void hold_keys();

  Window* window_;
  std::vector<int> held_;  ///< keys that were down for less than a frame
  std::string theme_;
  float size_ = 0;  ///< of the font, pixels
};

}  // namespace nacre
