// Nacre: a window with a context in it.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/gl/context.hpp"

struct GLFWwindow;

namespace nacre {

/// A key that went down with others held, by the letter that is on it on an American keyboard; 27 is Escape.
struct KeyPress {
  int key = 0;
  bool ctrl = false, shift = false;
};

/// One window by GLFW. Its context is current on the thread that made it, which must be the main thread.
class Window : public Context {
 public:
  /// Opens a window of width x height screen units. Throws Error where there is no display or no OpenGL 4.5.
  Window(const std::string& title, int width, int height);
  ~Window() override;

  void make_current() override;
  GLFWwindow* handle() const { return window_; }

  bool should_close() const;
  /// Takes what the user has done. Waits for that, at most a tenth of a second, while there is nothing to draw on.
  void poll();
  void swap();

  std::array<int, 2> pixels() const;  ///< of its framebuffer; (0, 0) while minimised
  float scale() const;                ///< pixels of this screen to one of an ordinary screen (DPI)

  /// Keys with ctrl, and Escape, since the last call: every one, however long a frame takes.
  std::vector<KeyPress> take_keys() { return std::exchange(keys_, {}); }

  /// All keys that went down since the last call, by GLFW's numbers, also those that are up again.
  std::vector<int> take_pressed() { return std::exchange(pressed_, {}); }

  /// Called in `poll` with the files that were dropped on the window.
  std::function<void(const std::vector<std::filesystem::path>& files)> on_drop;

 private:
  GLFWwindow* window_ = nullptr;
  std::vector<KeyPress> keys_;
  std::vector<int> pressed_;
};

}  // namespace nacre
