// Nacre: the session file: inputs and knobs, so that a run can be repeated.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/settings.hpp"

namespace nacre {

/// What a session file holds: {"nacre": version, "inputs": [files], "sample": name, "detail": number, "knobs": {...}}. Relative inputs
/// are relative to the session file.
struct Session {
  std::vector<std::filesystem::path> inputs;
  std::string sample;
  int detail = 0;  ///< of the sample; 0: its own
  Settings settings;
};

/// Throws Error where the file cannot be read, is no session, or holds a knob that is not known or out of range.
Session read_session(const std::filesystem::path& file);

/// The text of a session file.
std::string session_text(const Session& session);

}  // namespace nacre
