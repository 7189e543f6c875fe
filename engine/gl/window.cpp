// Nacre: a window, by GLFW.
#include "engine/gl/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/gl/errors.hpp"
#include "engine/system/faults.hpp"

namespace nacre {
namespace {

/// The last error message of GLFW.
std::string glfw_complaint() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "";
}

}  // namespace

Window::Window(const std::string& title, int width, int height) {
  if (!glfwInit())
    throw Error("no display to open a window on", glfw_complaint(),
                "start nacre view on a desktop, or draw without one: nacre view --offscreen --image FILE.png");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);  // everything is drawn into a Framebuffer; the window only gets the picture
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  for (const int told : {GLFW_LOSE_CONTEXT_ON_RESET, GLFW_NO_ROBUSTNESS}) {  // asks for reports of resets
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, told);
    if (!window_) window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  }
  if (!window_) {
    const std::string why = glfw_complaint();
    glfwTerminate();
    throw opengl_missing(why);
  }
  try {
    make_current();
    begin();
  } catch (...) {
    glfwTerminate();
    throw;
  }
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  listen();
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** names) {
    const auto* self = static_cast<const Window*>(glfwGetWindowUserPointer(window));
    if (self->on_drop) self->on_drop({names, names + count});
  });
}

void Window::listen() {
  static const auto queue = [](GLFWwindow* window) -> InputQueue& {
    return static_cast<Window*>(glfwGetWindowUserPointer(window))->input_;
  };
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action != GLFW_REPEAT && key >= 0) queue(window).add(KeyMoved{key, action == GLFW_PRESS});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned letter) { queue(window).add(TextTyped{letter}); });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
    queue(window).add(ButtonMoved{button, action == GLFW_PRESS});
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    queue(window).add(MouseMoved{x, y});
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int entered) {
    const bool pulling = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                         glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS ||
                         glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS;
    if (!entered && !pulling) queue(window).add(MouseMoved{mouse_outside, mouse_outside});
  });
  const auto damaged = [](GLFWwindow* window) {
    static_cast<Window*>(glfwGetWindowUserPointer(window))->damaged_ = true;
  };
  glfwSetWindowRefreshCallback(window_, damaged);
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int) {
    static_cast<Window*>(glfwGetWindowUserPointer(window))->damaged_ = true;
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) { queue(window).add(WheelTurned{x, y}); });
}

Window::~Window() { glfwTerminate(); }

void Window::make_current() { glfwMakeContextCurrent(window_); }

bool Window::should_close() const { return glfwWindowShouldClose(window_); }

void Window::keep_open() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

bool Window::is_minimised() const { return glfwGetWindowAttrib(window_, GLFW_ICONIFIED); }

void Window::poll(bool idles, double patience) {
  if (fault_due("other-screen")) density_ = 3 - density_, damaged_ = true;
  const auto [width, height] = pixels();
  if (width <= 0 || height <= 0 || (idles && is_minimised()))
    glfwWaitEventsTimeout(0.1);
  else if (patience > 0 && !touched())
    glfwWaitEventsTimeout(patience);
  else
    glfwPollEvents();
}

void Window::set_title(const std::string& title) {
  if (title == title_) return;  // saves a call to the window manager, which is another process
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::swap() {
  damaged_ = false;
  glfwSwapBuffers(window_);
}

std::array<int, 2> Window::pixels() const {
  std::array<int, 2> size{};
  glfwGetFramebufferSize(window_, &size[0], &size[1]);
  return size;
}

/// Screens that do not know their size report no number, or a senseless one.
float Window::scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  x *= float(density_);
  return x >= 0.25f && x <= 16 ? x : 1;
}

/// Windows and the mouse are measured in units of the desktop: pixels on X11 and Windows, larger units elsewhere.
std::array<double, 2> Window::pixels_per_unit() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const auto [across, down] = pixels();
  if (width <= 0 || height <= 0 || across <= 0 || down <= 0) return {1, 1};
  return {density_ * double(across) / width, density_ * double(down) / height};
}

InputFrame Window::next_input() {
  InputFrame frame = input_.next_frame();
  if (frame.x == mouse_outside) return frame;
  const auto [x, y] = pixels_per_unit();
  frame.x *= x, frame.y *= y;
  return frame;
}

}  // namespace nacre
