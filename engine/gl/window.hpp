// Nacre: a window with a context in it.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/gl/context.hpp"
#include "engine/gl/input_queue.hpp"

struct GLFWwindow;

namespace nacre {

/// One window by GLFW. Its context is current on the thread that made it, which must be the main thread.
class Window : public Context {
 public:
  /// Opens a window of width x height screen units. Throws Error where there is no display or no OpenGL 4.5.
  Window(const std::string& title, int width, int height);
  ~Window() override;

  void make_current() override;
  GLFWwindow* handle() const { return window_; }

  bool should_close() const;
  void keep_open();  ///< although the user wanted it to close
  /// Takes what the user has done. Waits for that, at most `patience` seconds; while there is nothing to draw on, at
  /// most a tenth of a second, where the window is merely minimised only if `idles`.
  void poll(bool idles, double patience = 0);
  bool is_minimised() const;
  /// Has the user done anything that no frame has seen, or has the window to be drawn again?
  bool touched() const { return damaged_ || input_.waits(); }
  void swap();
  void set_title(const std::string& title);

  // Both may be others in the next frame: a window can be moved to another screen.
  std::array<int, 2> pixels() const;  ///< of its framebuffer; (0, 0) while minimised
  float scale() const;                ///< pixels of this screen to one of an ordinary screen (DPI); 0.25 to 16

  /// User input since the last frame; to be asked for once a frame. The mouse position is in pixels.
  InputFrame next_input();

  /// Called in `poll` with the files that were dropped on the window.
  std::function<void(const std::vector<std::filesystem::path>& files)> on_drop;

 private:
  void listen();
  std::array<double, 2> pixels_per_unit() const;

  GLFWwindow* window_ = nullptr;
  std::string title_;
  InputQueue input_;
  bool damaged_ = true;
  int density_ = 1;  ///< 2: acts as on a screen of twice the density; for tests
};

}  // namespace nacre
