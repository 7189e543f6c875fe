// Nacre: a window with an OpenGL context.
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

/// One window, by GLFW. Its context is current on the thread that made it, which must be the main thread.
class Window : public Context {
 public:
  /// Opens a window of width x height screen units. Throws Error if there is no display or no OpenGL 4.5.
  Window(const std::string& title, int width, int height);
  ~Window() override;

  void make_current() override;
  GLFWwindow* handle() const { return window_; }

  bool should_close() const;
  /// Collects the user's input. Waits for it, at most a tenth of a second, while there is nothing to draw on; if the
  /// window is only minimised, it waits only if `idles`.
  void poll(bool idles);
  void swap();
  void set_title(const std::string& title);

  // Both may change from frame to frame: a window can be moved to another screen.
  std::array<int, 2> pixels() const;  ///< of its framebuffer; (0, 0) while minimised
  float scale() const;                ///< pixels of this screen per pixel of an ordinary screen (DPI); 0.25 to 16

  /// The user's input of this frame; to be called once per frame. The mouse position is in pixels.
  InputFrame next_input();

  /// Called in `poll` with the files that were dropped on the window.
  std::function<void(const std::vector<std::filesystem::path>& files)> on_drop;

 private:
  void listen();
  std::array<double, 2> pixels_per_unit() const;

  GLFWwindow* window_ = nullptr;
  std::string title_;
  InputQueue input_;
  int density_ = 1;  ///< 2: acts as on a screen of twice the density; for tests
};

}  // namespace nacre
