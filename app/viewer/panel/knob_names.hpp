// Nacre: texts of the knobs for people: plain names, which ones come first, and what a change costs.
#pragma once

#include <string>
#include <vector>

namespace nacre {

/// What people call it: "Streak length"; empty: it has its own name only.
std::string plain_name(const std::string& knob);

/// The knobs of a job ("flow", "mesh") that come first, by their names.
const std::vector<std::string>& basic_knobs(const std::string& job);

/// What the viewer does again when it is changed: "restarts the texture"; of knobs of no job, empty.
std::string knob_cost(const std::string& knob, const std::string& job);

}  // namespace nacre
