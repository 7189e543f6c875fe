// Nacre: what a newcomer sees first.
#include "app/viewer/panel/welcome_card.hpp"

#include <imgui.h>

#include <algorithm>

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

/// A tour, with what it shows beside its name.
void tour(const char* name, const char* help, const char* text, WelcomeCard::Wish& wish) {
  if (ImGui::Button(name)) wish.tour = text;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
  ImGui::SameLine();
}

}  // namespace

WelcomeCard::Wish WelcomeCard::draw(const FreeArea& area, const std::vector<std::filesystem::path>& recent) {
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
      for (std::size_t k = 0; k < std::min(most_recent, recent.size()); ++k) {
        ImGui::PushID(int(k));
        if (ImGui::Selectable(recent[k].filename().string().c_str())) wish.file = recent[k];
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", recent[k].string().c_str());
        ImGui::PopID();
      }
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
