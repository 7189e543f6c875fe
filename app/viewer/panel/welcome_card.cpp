// Nacre: what a newcomer sees first.
#include "app/viewer/panel/welcome_card.hpp"

#include <imgui.h>

#include <algorithm>
#include <cstdint>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/tours.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/samples/samples.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_recent = 5;

void heading(const char* title) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", title);
}

template <class Sample>
void offer(const std::vector<Sample>& all, WelcomeCard::Wish& wish, float wide) {
  for (const Sample& sample : all) {
    if (ImGui::Selectable(sample.name.c_str(), false, 0, ImVec2(wide, 0))) wish.sample = sample.name;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", sample.help.c_str());
  }
}

/// Pictures in a row, with the names below them.
void offer_recent(const std::vector<RecentFile>& recent, WelcomeCard::Wish& wish) {
  const std::size_t count = std::min(most_recent, recent.size());
  const float wide = ImGui::GetContentRegionAvail().x / float(most_recent) - ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size(wide, 0.75f * wide), corner = ImGui::GetCursorScreenPos();
  for (std::size_t k = 0; k < count; ++k) {
    const RecentFile& each = recent[k];
    const std::string name = each.file.filename().string();
    ImGui::PushID(int(k));
    ImGui::SetCursorScreenPos(ImVec2(corner.x + float(k) * (wide + ImGui::GetStyle().ItemSpacing.x), corner.y));
    ImGui::BeginGroup();
    if (ImGui::InvisibleButton("open", ImVec2(wide, size.y + 1.3f * ImGui::GetFontSize()))) wish.file = each.file;
    const ImVec2 low = ImGui::GetItemRectMin(), high(low.x + size.x, low.y + size.y);
    ImDrawList& lines = *ImGui::GetWindowDrawList();
    if (each.picture)
      lines.AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(each.picture)), low, high);
    else
      lines.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const bool hovered = ImGui::IsItemHovered();
    lines.AddRect(low, high, ImGui::GetColorU32(hovered ? ImGuiCol_ButtonHovered : ImGuiCol_Border), 0, 0,
                  hovered ? 2.0f : 1.0f);
    lines.PushClipRect(ImVec2(low.x, high.y), ImVec2(high.x, high.y + 1.4f * ImGui::GetFontSize()), true);
    lines.AddText(ImVec2(low.x, high.y + 0.15f * ImGui::GetFontSize()), ImGui::GetColorU32(ImGuiCol_Text),
                  name.c_str());
    lines.PopClipRect();
    ImGui::EndGroup();
    if (hovered) ImGui::SetTooltip("%s", each.file.string().c_str());
    ImGui::PopID();
  }
}

/// A tour, with what it shows beside its name.
void tour(const char* name, const char* help, const char* text, WelcomeCard::Wish& wish) {
  if (ImGui::Button(name)) wish.tour = text;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
  ImGui::SameLine();
}

}  // namespace

WelcomeCard::Wish WelcomeCard::draw(const FreeArea& area, const std::vector<RecentFile>& recent) {
  Wish wish;
  if (!shown_) return wish;
  const float font = ImGui::GetFontSize(), wide = std::min(32 * font, 0.95f * float(area.width));
  ImGui::SetNextWindowPos(ImVec2(float(area.x) + 0.5f * float(area.width), float(area.y) + 0.5f * float(area.height)),
                          ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(wide, 0), ImVec2(wide, 0.95f * float(area.height)));
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(1.2f * font, font));
  const auto fixed = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove;
  const bool drawn = ImGui::Begin("Welcome to Nacre", &shown_, fixed);
  ImGui::PopStyleVar();
  if (drawn) {
    ImGui::TextWrapped("Drop a file on this window: a surface with vectors shows its flow, a volume becomes a mesh.");
    ImGui::Spacing();
    if (ImGui::Button("Open a file ...")) wish.open = true;
    ImGui::SameLine();
    ImGui::TextDisabled("ctrl o");
    if (!recent.empty()) {
      heading("opened last");
      offer_recent(recent, wish);
    }
    heading("or replay a tour");
    tour("flow around a train", "a flow, from near and from far (11 s)", flow_tour, wish);
    tour("a mesh of a torso", "how a mesh is made: particles, triangles, materials (12 s)", mesh_tour, wish);
    ImGui::NewLine();
    if (ImGui::BeginTable("samples", 2)) {
      const float column = 0.45f * wide;
      ImGui::TableNextColumn();
      heading("samples of flow");
      offer(samples(), wish, column);
      ImGui::TableNextColumn();
      heading("samples of volumes");
      offer(phantoms(), wish, column);
      ImGui::EndTable();
    }
  }
  ImGui::End();
  if (wish.open || !wish.sample.empty() || !wish.tour.empty() || wish.file) shown_ = false;
  return wish;
}

}  // namespace nacre
