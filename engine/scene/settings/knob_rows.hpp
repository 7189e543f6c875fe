// Nacre: the parts of the knob table that have files of their own; knob_table.cpp puts them together.
#pragma once

#include "engine/scene/settings/knobs.hpp"

namespace nacre {

std::vector<Knob> mesh_knobs(Settings& settings);
std::vector<Knob> view_knobs(Settings& settings);

}  // namespace nacre
