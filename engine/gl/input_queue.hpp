// Nacre: what a user does at the keyboard and mouse, in order, handed out frame by frame. However long a frame takes,
// no tap, click or chord is lost: what would undo or outrun something else of its frame waits for the next.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace nacre {

/// Where the mouse is when it is not in the window.
constexpr double mouse_outside = -1e6;

struct KeyMoved {
  int key = 0;  ///< by GLFW's numbers
  bool down = false;
};
struct ButtonMoved {
  int button = 0;
  bool down = false;
};
struct MouseMoved {
  double x = 0, y = 0;  ///< screen units from the window's upper left corner, or mouse_outside
};
struct WheelTurned {
  double x = 0, y = 0;
};
struct TextTyped {
  char32_t letter = 0;
};
using InputEvent = std::variant<KeyMoved, ButtonMoved, MouseMoved, WheelTurned, TextTyped>;

/// A key that went down with others held, by the letter that is on it on an American keyboard; 27 is Escape.
struct KeyPress {
  int key = 0;
  bool ctrl = false, shift = false;
};

/// What a program that looks once a frame shall see in this one.
struct InputFrame {
  std::map<int, bool> keys;         ///< that moved
  std::map<int, bool> buttons;      ///< that moved
  double x = 0, y = 0;              ///< the mouse, as in MouseMoved
  double wheel_x = 0, wheel_y = 0;  ///< turns
  std::u32string text;              ///< typed
  std::vector<KeyPress> chords;     ///< keys with ctrl, and Escape
};

class InputQueue {
 public:
  void add(const InputEvent& event) { waiting_.push_back(event); }

  /// The next frame's. Within it modifiers come first, then the mouse, its buttons, letters, other keys; each key and
  /// button moves once. What follows a chord waits for what that may have opened: three frames.
  InputFrame next_frame();

 private:
  bool held(int left, int right) const;
  void apply(const InputEvent& event, InputFrame& frame);

  std::deque<InputEvent> waiting_;
  std::map<int, bool> down_;  ///< keys
  double x_ = mouse_outside, y_ = mouse_outside;
  int pause_ = 0;  ///< frames
};

}  // namespace nacre
