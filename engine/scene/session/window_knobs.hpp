// Nacre: the knobs that belong to the window and the person at it. No keyframe holds them, and two views
// that are compared share them.
#pragma once

#include <optional>
#include <string>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// Panels, theme, text size and the like; and the size and frame rate of the picture, which stay as they begin.
bool is_window_knob(const std::string& name);

/// `to` takes over their values from `from`.
void copy_window_knobs(const Settings& from, Settings& to);

/// As `session_change`, without these knobs.
std::optional<SessionEvent> shown_change(const Session& before, const Session& after);

/// The recording as it is played in a window that has these settings and is to keep them.
Session played_in_window(Session recording, const Settings& window);

}  // namespace nacre
