// Nacre: keyboard and mouse events in order, handed out frame by frame. However long a frame takes, no tap, click or
// key combination is lost: what would undo or overtake another event of its frame waits for the next frame.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace nacre {

/// The mouse position while it is outside of the window.
constexpr double mouse_outside = -1e6;

struct KeyMoved {
  int key = 0;  ///< in GLFW's numbering
  bool down = false;
};
struct ButtonMoved {
  int button = 0;
  bool down = false;
};
struct MouseMoved {
  double x = 0, y = 0;  ///< screen units from the upper left corner of the window, or mouse_outside
};
struct WheelTurned {
  double x = 0, y = 0;
};
struct TextTyped {
  char32_t letter = 0;
};
using InputEvent = std::variant<KeyMoved, ButtonMoved, MouseMoved, WheelTurned, TextTyped>;

/// A key pressed while others were held, by its letter on an American keyboard; 27 is Escape.
struct KeyPress {
  int key = 0;
  bool ctrl = false, shift = false;
};

/// The events that a program which polls once per frame sees in this frame.
struct InputFrame {
  std::map<int, bool> keys;         ///< that changed
  std::map<int, bool> buttons;      ///< that changed
  double x = 0, y = 0;              ///< the mouse, as in MouseMoved
  double wheel_x = 0, wheel_y = 0;  ///< steps of the wheel
  std::u32string text;              ///< typed
  std::vector<KeyPress> chords;     ///< keys with ctrl, and Escape
};

class InputQueue {
 public:
  void add(const InputEvent& event) { waiting_.push_back(event); }

  /// The input of the next frame. Within a frame modifiers come first, then the mouse, its buttons, letters, other
  /// keys; each key and button changes once. What follows a key combination waits three frames for what that may have
  /// opened.
  InputFrame next_frame();
  /// Is there something for the next frame, or a pause that ends with one?
  bool waits() const { return !waiting_.empty() || pause_ > 0; }

 private:
  bool held(int left, int right) const;
  void apply(const InputEvent& event, InputFrame& frame);

  std::deque<InputEvent> waiting_;
  std::map<int, bool> down_;  ///< keys
  double x_ = mouse_outside, y_ = mouse_outside;
  int pause_ = 0;  ///< frames
};

}  // namespace nacre
