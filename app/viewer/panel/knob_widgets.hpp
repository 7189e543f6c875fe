// Nacre: widgets for the knobs of the table.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// One knob by its name, with its unit and help. Numbers are clamped to their range, min_size and max_size to each
/// other; sliders and text take effect when they are let go. `choices`: for a knob with fixed choices; none: any text.
void knob_widget(Settings& settings, const std::string& name, const std::vector<std::string>& choices = {});

/// Knobs of a job ("flow", "mesh"): the basic ones with plain names, and all others in their groups under "Advanced";
/// with a `filter`, all that contain it in name or help. Without those of the view. Changed ones are marked, a right
/// click resets.
void knob_groups(Settings& settings, const std::string& job, const std::string& filter);

/// All knobs of `job` as they are by default; the view, and what is shown of which arrays, stay.
void reset_knobs(Settings& settings, const std::string& job);

}  // namespace nacre
