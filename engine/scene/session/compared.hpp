// Nacre: what a second view beside the first shows, for comparison: other data, or the same data with other knobs.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// The knob `compare` means: the same input as the first view.
inline constexpr const char* compare_same = "same";

/// Is there a second view?
inline bool compares(const Session& session) { return !session.settings.view.compare.empty(); }

/// The input that the knob `compare` names: `same`, `sample:NAME` or `sample:NAME:DETAIL`, or `FILE[;FILE...]`.
SessionInput compared_input(const Session& session);
/// The value of the knob for an input.
std::string compare_text(const SessionInput& input);
/// That value with whole names of files, which may be relative to `folder`.
std::string compare_beside(const std::filesystem::path& folder, const std::string& compare);

/// The knobs in which the second view differs: `name=value[;name=value...]`. Throws Error where it is something else, a
/// knob is unknown or out of range, or both views share it.
std::map<std::string, std::string> parse_compare_knobs(const std::string& text);
std::string compare_knobs_text(const std::map<std::string, std::string>& knobs);

/// Can the views differ in this knob? Time, camera, window and marks are the same for both.
bool can_differ(const std::string& knob);

/// The session of the second view: that of the first with its own input and knobs. Throws Error where these mean
/// nothing.
Session compared_session(const Session& session);

/// The first view becomes the second, and the second the first.
void swap_compared(Session& session);

/// What differs, for a heading above each view: the values of the knobs, and the input where that is another one.
std::string first_heading(const Session& session);
std::string second_heading(const Session& session);

}  // namespace nacre
