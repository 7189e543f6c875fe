// Nacre: the second view: its knobs, with Dear ImGui.
#include "app/viewer/panel/compare_panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <vector>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "app/viewer/scene/scene.hpp"
#include "engine/scene/session/compared.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

using Different = std::map<std::string, std::string>;

std::string value_in(Settings settings, const std::string& name) {
  for (const Knob& knob : knobs(settings))
    if (knob.name == name) return knob.text();
  return "";
}

/// One line for each knob; a cross makes it the same in both views again.
void different_knobs(Different& differ, const Session& second) {
  Different shown = differ;
  for (const auto& [name, value] : shown) {
    ImGui::PushID(name.c_str());
    if (ImGui::SmallButton("x")) differ.erase(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("the same in both views again");
    ImGui::SameLine();
    Settings settings = second.settings;
    knob_widget(settings, name);
    if (differ.contains(name)) differ[name] = value_in(settings, name);
    ImGui::PopID();
  }
}

void another_knob(Different& differ, const Session& second) {
  ImGui::SetNextItemWidth(0.6f * ImGui::GetContentRegionAvail().x);
  if (!ImGui::BeginCombo("##another", "another knob that differs")) return;
  Settings settings = second.settings;
  const std::string job = is_mesh_input(second) ? "mesh" : "flow";
  for (const Knob& knob : knobs(settings))
    if (can_differ(knob.name) && !differ.contains(knob.name) && (knob.concerns(job) || knob.group == "view"))
      if (ImGui::Selectable(knob.name.c_str())) differ[knob.name] = knob.text();
  ImGui::EndCombo();
}

}  // namespace

void compare_section(Session& session) {
  ViewSettings& view = session.settings.view;
  knob_widget(session.settings, "compare");
  if (!compares(session)) return text("View, \"Compare with\" opens a second view");
  try {
    const Session second = compared_session(session);
    Different differ = parse_compare_knobs(view.compare_knobs);
    different_knobs(differ, second);
    another_knob(differ, second);
    view.compare_knobs = compare_knobs_text(differ);
    if (ImGui::Button("swap views")) swap_compared(session);
    ImGui::SameLine();
    if (!differ.empty() && ImGui::Button("use its knobs in both")) {
      const std::string compare = view.compare;
      session.settings = second.settings;
      view.compare = compare;
    }
  } catch (const std::exception& error) {
    ImGui::TextWrapped("%s", error.what());
    if (ImGui::Button("no second view")) view.compare.clear(), view.compare_knobs.clear();
  }
}

}  // namespace nacre
