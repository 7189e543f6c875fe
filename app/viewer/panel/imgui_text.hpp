// Nacre: lines of text for the panels, and windows that cannot be seen.
#pragma once

#include <imgui.h>

#include <string>

#include "app/viewer/scene/text.hpp"

namespace nacre {

/// A line as it is, with no sign in it that Dear ImGui would take for its own.
inline void text(const std::string& line) { ImGui::TextUnformatted(line.data(), line.data() + line.size()); }

/// Of a window that only receives the mouse over a part of the picture.
inline constexpr ImGuiWindowFlags bare_window = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                                ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                                                ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing |
                                                ImGuiWindowFlags_NoBringToFrontOnFocus;

}  // namespace nacre
