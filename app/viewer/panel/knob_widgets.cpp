// Nacre: widgets for the knobs of the table.
#include "app/viewer/panel/knob_widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/scene/view_defaults.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

/// What a slider or a text field shows while the user is at it; it becomes the knob's when it is let go.
template <class T, class Widget>
bool let_go(T& value, const Widget& widget) {
  struct Held {
    T value;
    bool active;
  };
  static std::map<ImGuiID, Held> all;
  Held& held = all.try_emplace(ImGui::GetID("held"), Held{value, false}).first->second;
  if (!held.active) held.value = value;
  widget(held.value);
  const bool done = ImGui::IsItemDeactivatedAfterEdit() && held.value != value;
  held.active = ImGui::IsItemActive();
  if (done) value = held.value;
  return done;
}

void whole_widget(int& value, const Knob& knob) {
  let_go(value, [&](int& shown) {
    if (knob.max - knob.min <= 64)
      ImGui::SliderInt("##value", &shown, int(knob.min), int(knob.max), "%d", ImGuiSliderFlags_AlwaysClamp);
    else
      ImGui::InputInt("##value", &shown, 0);
  });
  value = int(std::clamp(double(value), knob.min, knob.max));
}

void real_widget(double& value, const Knob& knob) {
  const bool wide = knob.min > 0 && knob.max / knob.min > 200;
  const auto flags = ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
  const bool done = let_go(value, [&](double& shown) {
    ImGui::SliderScalar("##value", ImGuiDataType_Double, &shown, &knob.min, &knob.max, "%.4g", flags);
  });
  if (done)
    value = std::clamp(std::stod(fmt::format("{:.4g}", value)), knob.min, knob.max);  // as a person would write it
}

void choice_widget(std::string& value, const std::vector<std::string>& choices) {
  const auto shown = [](const std::string& choice) { return choice.empty() ? "(the likeliest)" : choice.c_str(); };
  if (!ImGui::BeginCombo("##value", shown(value))) return;
  for (const std::string& each : choices)
    if (ImGui::Selectable(shown(each), each == value)) value = each;
  ImGui::EndCombo();
}

void words_widget(std::string& value) {
  let_go(value, [](std::string& shown) { ImGui::InputText("##value", &shown); });
}

void value_widget(const Knob& knob, const std::vector<std::string>& choices) {
  if (auto* const* flag = std::get_if<bool*>(&knob.value)) ImGui::Checkbox("##value", *flag);
  if (auto* const* whole = std::get_if<int*>(&knob.value)) whole_widget(**whole, knob);
  if (auto* const* real = std::get_if<double*>(&knob.value)) real_widget(**real, knob);
  if (auto* const* number = std::get_if<std::uint32_t*>(&knob.value)) {
    let_go(**number, [](std::uint32_t& shown) { ImGui::InputScalar("##value", ImGuiDataType_U32, &shown); });
    if (knob.also) *knob.also = **number;
  }
  if (const auto* choice = std::get_if<KnobChoice>(&knob.value)) {
    std::string name = knob.text();
    choice_widget(name, knob.choices);
    const auto chosen = std::find(knob.choices.begin(), knob.choices.end(), name);
    choice->set(choice->place, int(chosen - knob.choices.begin()));
  }
  if (auto* const* words = std::get_if<std::string*>(&knob.value)) {
    if (knob.name == "colormap")
      choice_widget(**words, colormap_names());
    else if (!knob.choices.empty() || !choices.empty())
      choice_widget(**words, knob.choices.empty() ? choices : knob.choices);
    else
      words_widget(**words);
  }
}

/// Its value when the viewer begins.
std::string default_text(const Knob& knob) {
  static Settings defaults = view_defaults();
  static const std::vector<Knob> table = knobs(defaults);
  for (const Knob& each : table)
    if (each.name == knob.name) return each.text();
  return "";
}

/// The smallest and the largest distance of particles do not pass each other: the one that is turned ends at the other.
void keep_sizes_in_order(Settings& settings, const std::string& turned) {
  double &smallest = settings.mesh.min_size, &largest = settings.mesh.max_size;
  if (turned == "min_size") smallest = std::min(smallest, largest);
  if (turned == "max_size") largest = std::max(smallest, largest);
}

void explain(const std::string& help, bool changed, const std::string& usual) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  text(help);
  if (changed) text(usual.empty() ? "right click: empty again" : "right click: " + usual + " again");
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void show(Settings& settings, const Knob& knob, const std::vector<std::string>& choices = {}) {
  ImGui::PushID(knob.name.c_str());
  const std::string usual = default_text(knob);
  const bool changed = knob.text() != usual;
  ImGui::BeginGroup();  // the field and its name are one thing to the mouse
  ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
  value_widget(knob, choices);
  ImGui::SameLine();
  const std::string label = (changed ? "* " : "") + knob.name + (knob.unit.empty() ? "" : " [" + knob.unit + "]");
  ImGui::TextUnformatted(label.c_str());
  ImGui::EndGroup();
  if (ImGui::IsItemHovered() && !ImGui::IsAnyItemActive()) explain(knob.help, changed, usual);
  if (changed && ImGui::IsItemClicked(1)) set_knob(settings, knob.name, usual);
  keep_sizes_in_order(settings, knob.name);
  ImGui::PopID();
}

}  // namespace

void knob_widget(Settings& settings, const std::string& name, const std::vector<std::string>& choices) {
  for (const Knob& knob : knobs(settings))
    if (knob.name == name) return show(settings, knob, choices);
}

void knob_groups(Settings& settings, const std::string& job, const std::string& filter) {
  std::string group;
  bool open = false;
  for (const Knob& knob : knobs(settings)) {
    if (!knob.concerns(job) || knob.group == "picture" || knob.group == "frames") continue;
    if (!filter.empty() && knob.name.find(filter) == std::string::npos && knob.help.find(filter) == std::string::npos)
      continue;
    if (knob.group != group) {
      group = knob.group;
      open = ImGui::CollapsingHeader(group.c_str(), ImGuiTreeNodeFlags_DefaultOpen);
    }
    if (open) show(settings, knob);
  }
}

void reset_knobs(Settings& settings, const std::string& job) {
  for (const Knob& knob : knobs(settings)) {
    const bool data = knob.name == "vectors" || knob.name == "color" || knob.group == "materials";
    if (knob.concerns(job) && knob.group != "picture" && !data) set_knob(settings, knob.name, default_text(knob));
  }
}

}  // namespace nacre
