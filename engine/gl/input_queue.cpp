// Nacre: a user's input, frame by frame.
#include "engine/gl/input_queue.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace nacre {
namespace {

/// The order of events within a frame: nothing may follow an event that is further down in this list.
enum class Rank { modifier, mouse, button, letter, other_key };

Rank rank_of(const InputEvent& event) {
  if (std::holds_alternative<MouseMoved>(event)) return Rank::mouse;
  if (std::holds_alternative<TextTyped>(event)) return Rank::letter;
  const auto* key = std::get_if<KeyMoved>(&event);
  if (!key) return Rank::button;
  if (key->key >= GLFW_KEY_LEFT_SHIFT && key->key <= GLFW_KEY_RIGHT_SUPER) return Rank::modifier;
  return key->key < GLFW_KEY_ESCAPE ? Rank::letter : Rank::other_key;
}

bool moved_already(const InputEvent& event, const InputFrame& frame) {
  if (const auto* key = std::get_if<KeyMoved>(&event)) return frame.keys.count(key->key) > 0;
  if (const auto* button = std::get_if<ButtonMoved>(&event)) return frame.buttons.count(button->button) > 0;
  return false;
}

/// Text does not follow a click within one frame, since the click may select the field that the text is for. Of other
/// keys there is one per frame.
bool may_follow(Rank next, Rank last) {
  if (last == Rank::button) return next == Rank::button;
  return next > last || (next == last && next != Rank::other_key);
}

}  // namespace

bool InputQueue::held(int left, int right) const {
  const auto is_down = [&](int key) { return down_.count(key) > 0 && down_.at(key); };
  return is_down(left) || is_down(right);
}

void InputQueue::apply(const InputEvent& event, InputFrame& frame) {
  if (const auto* key = std::get_if<KeyMoved>(&event)) {
    frame.keys[key->key] = down_[key->key] = key->down;
    const bool escape = key->key == GLFW_KEY_ESCAPE;
    const bool ctrl =
        held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL) || held(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
    if (key->down && (escape || (ctrl && rank_of(event) != Rank::modifier)))
      frame.chords.push_back({escape ? 27 : key->key, ctrl, held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT)});
  } else if (const auto* button = std::get_if<ButtonMoved>(&event)) {
    frame.buttons[button->button] = button->down;
  } else if (const auto* mouse = std::get_if<MouseMoved>(&event)) {
    x_ = mouse->x, y_ = mouse->y;
  } else if (const auto* wheel = std::get_if<WheelTurned>(&event)) {
    frame.wheel_x += wheel->x, frame.wheel_y += wheel->y;
  } else if (const auto* typed = std::get_if<TextTyped>(&event)) {
    frame.text += typed->letter;
  }
}

InputFrame InputQueue::next_frame() {
  InputFrame frame;
  Rank last = Rank::modifier;
  if (pause_ > 0) --pause_;
  while (pause_ == 0 && !waiting_.empty()) {
    const InputEvent& event = waiting_.front();
    if (!may_follow(rank_of(event), last) || moved_already(event, frame)) break;
    last = rank_of(event);
    apply(event, frame);
    waiting_.pop_front();
    if (!frame.chords.empty()) pause_ = 3;
  }
  frame.x = x_, frame.y = y_;
  return frame;
}

}  // namespace nacre
