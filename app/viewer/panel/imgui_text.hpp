// Nacre: lines of text for the panels.
#pragma once

#include <imgui.h>

#include <string>

#include "app/viewer/scene/text.hpp"

namespace nacre {

/// A line as it is, with no sign in it that Dear ImGui would take for its own.
inline void text(const std::string& line) { ImGui::TextUnformatted(line.data(), line.data() + line.size()); }

}  // namespace nacre
