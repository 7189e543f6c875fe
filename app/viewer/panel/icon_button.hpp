// Nacre: buttons with the signs of a player.
#pragma once

#include <imgui.h>

#include <string>

namespace nacre {

/// Draws a sign about its middle; `r` is half its height.
using Icon = void (*)(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);

void play_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);
void pause_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);
void stop_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);
void back_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);
void forth_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);
void begin_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);
void loop_icon(ImDrawList& list, const ImVec2& middle, float r, ImU32 colour);

/// The next item follows it in the same line. `lit`: in the colour of what is on.
bool icon_button(const char* name, Icon icon, const std::string& help, bool lit = false);

}  // namespace nacre
