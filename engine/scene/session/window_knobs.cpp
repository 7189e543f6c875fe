// Nacre: the knobs that belong to the window and the person at it.
#include "engine/scene/session/window_knobs.hpp"

#include <algorithm>
#include <iterator>

#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

constexpr const char* window_knobs[] = {"panel",   "panel_side", "panel_width", "tab",   "theme",  "text_size",
                                        "turning", "cameras",    "play_speed",  "width", "height", "fps"};

bool changes_nothing(const SessionEvent& event) { return !event.input && event.knobs.empty() && !event.camera; }

}  // namespace

bool is_window_knob(const std::string& name) {
  return std::find(std::begin(window_knobs), std::end(window_knobs), name) != std::end(window_knobs);
}

void copy_window_knobs(const Settings& from, Settings& to) {
  Settings source = from;
  for (const Knob& knob : knobs(source))
    if (is_window_knob(knob.name)) set_knob(to, knob.name, knob.text());
}

std::optional<SessionEvent> shown_change(const Session& before, const Session& after) {
  std::optional<SessionEvent> change = session_change(before, after);
  if (!change) return {};
  std::erase_if(change->knobs, [](const auto& knob) { return is_window_knob(knob.first); });
  return changes_nothing(*change) ? std::nullopt : change;
}

Session played_in_window(Session recording, const Settings& window) {
  copy_window_knobs(window, recording.settings);
  for (SessionEvent& event : recording.events)
    std::erase_if(event.knobs, [](const auto& knob) { return is_window_knob(knob.first); });
  return recording;
}

}  // namespace nacre
