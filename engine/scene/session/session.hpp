// Nacre: the session file: inputs, knobs, camera, and what was changed when. One file drives viewer and commands.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compute/raycast/camera.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// What is shown: files, or a built-in sample.
struct SessionInput {
  std::vector<std::filesystem::path> inputs;
  std::string sample;
  int detail = 0;  ///< of the sample; 0: its own

  bool operator==(const SessionInput&) const = default;
};

/// A picture of the frame at an event.
struct Screenshot {
  std::filesystem::path file;  ///< PNG
  int scale = 1;               ///< pixels of it to one of the frame and axis, 1 to 4
  bool panel = false;          ///< with the panels (at scale 1)
  bool transparent = false;    ///< without background

  bool operator==(const Screenshot&) const = default;
};

inline constexpr double longest_session = 1e6;  ///< seconds

/// What is different from a time on.
struct SessionEvent {
  double time = 0;  ///< seconds since the beginning: the first frame at or after it shows the change
  std::optional<SessionInput> input;
  std::map<std::string, std::string> knobs;  ///< by name, as on the command line
  std::optional<Camera> camera;
  double over = 0;  ///< seconds that the camera takes to get there
  std::optional<Screenshot> screenshot;
};

/// What a session file holds:
///   {"nacre": "session 1", "inputs": [files], "sample": name, "detail": number, "knobs": {...}, "camera": {...},
///    "events": [{"time": 0.4, "knobs": {...}, "camera": {...}, "over": 1, "inputs": .., "sample": .., "detail": ..,
///                "screenshot": {"file": "a.png", "scale": 2, "panel": false, "transparent": false}}],
///    "duration": 5}
/// All may be left out, and "detail" goes with inputs or a sample. Relative files, also one that the knob "camera"
/// names, are relative to the session file. A session with events is a recording, or a script that somebody wrote;
/// without, it is the state of a view. An event's input without a camera, or its knob "camera" without one, has the
/// camera fitted as at the start.
struct Session : SessionInput {
  Settings settings;
  std::optional<Camera> camera;      ///< none: as the knob says
  std::vector<SessionEvent> events;  ///< by time
  double duration = 0;               ///< of the recording, seconds; at least to the last event's end
};

/// Throws Error where the file cannot be read, is no session, or holds a knob that is not known or out of range.
Session read_session(const std::filesystem::path& file);

/// The same from its text; files are relative to the current folder.
Session parse_session(const std::string& text);

/// The text of a session file. Throws Error where the name of a file is no UTF-8, which JSON cannot hold.
std::string session_text(const Session& session);

/// What has to happen (at time 0) to `before` so that it becomes `after`: inputs, knobs, camera. None where they agree.
std::optional<SessionEvent> session_change(const Session& before, const Session& after);

/// Does the event leave the camera to be fitted again?
bool fits_camera(const SessionEvent& event);

/// Makes the whole change; a camera that is to be fitted is removed. Throws Error where a knob is unknown or out of
/// range.
void apply_event(const SessionEvent& event, Session& session);

}  // namespace nacre
