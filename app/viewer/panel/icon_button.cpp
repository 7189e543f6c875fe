// Nacre: buttons with the signs of a player.
#include "app/viewer/panel/icon_button.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

void bar(ImDrawList& list, const ImVec2& m, float x, float r, ImU32 colour) {
  list.AddRectFilled(ImVec2(m.x + x - 0.22f * r, m.y - r), ImVec2(m.x + x + 0.22f * r, m.y + r), colour);
}

/// Points to the right for r > 0.
void arrow(ImDrawList& list, const ImVec2& m, float x, float r, ImU32 colour) {
  const float high = std::abs(r);
  const ImVec2 tip(m.x + x + 0.9f * r, m.y), a(m.x + x - 0.7f * r, m.y - high), b(m.x + x - 0.7f * r, m.y + high);
  if (r > 0)
    list.AddTriangleFilled(a, tip, b, colour);
  else
    list.AddTriangleFilled(b, tip, a, colour);
}

}  // namespace

void play_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) { arrow(list, m, 0, r, colour); }
void pause_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) {
  bar(list, m, -0.45f * r, r, colour);
  bar(list, m, 0.45f * r, r, colour);
}
void back_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) {
  arrow(list, m, -0.2f * r, -0.75f * r, colour);
  bar(list, m, 0.75f * r, 0.75f * r, colour);
}
void forth_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) {
  bar(list, m, -0.75f * r, 0.75f * r, colour);
  arrow(list, m, 0.2f * r, 0.75f * r, colour);
}
void begin_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) {
  bar(list, m, -0.85f * r, 0.75f * r, colour);
  arrow(list, m, -0.05f * r, -0.7f * r, colour);
  arrow(list, m, 0.8f * r, -0.7f * r, colour);
}
void loop_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) {
  list.PathArcTo(m, 0.8f * r, -0.6f, 4.6f, 24);
  list.PathStroke(colour, 0, std::max(1.5f, 0.25f * r));
  const ImVec2 tip(m.x + 0.8f * r * std::cos(-0.6f), m.y + 0.8f * r * std::sin(-0.6f));
  list.AddTriangleFilled(ImVec2(tip.x - 0.55f * r, tip.y - 0.1f * r), ImVec2(tip.x + 0.35f * r, tip.y - 0.45f * r),
                         ImVec2(tip.x + 0.3f * r, tip.y + 0.45f * r), colour);
}
void stop_icon(ImDrawList& list, const ImVec2& m, float r, ImU32 colour) {
  list.AddRectFilled(ImVec2(m.x - 0.8f * r, m.y - 0.8f * r), ImVec2(m.x + 0.8f * r, m.y + 0.8f * r), colour);
}

bool icon_button(const char* name, Icon icon, const std::string& help, bool lit) {
  const float size = ImGui::GetFrameHeight();
  const bool pressed = ImGui::InvisibleButton(name, ImVec2(1.25f * size, size));
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImGuiCol back = ImGui::IsItemActive() ? ImGuiCol_ButtonActive : ImGuiCol_ButtonHovered;
  if (ImGui::IsItemHovered()) list.AddRectFilled(low, high, ImGui::GetColorU32(back), ImGui::GetStyle().FrameRounding);
  icon(list, ImVec2(0.5f * (low.x + high.x), 0.5f * (low.y + high.y)), 0.27f * size,
       ImGui::GetColorU32(lit && !ImGui::IsItemHovered() ? ImGuiCol_CheckMark : ImGuiCol_Text));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help.c_str());
  ImGui::SameLine(0, 0);
  return pressed;
}

}  // namespace nacre
