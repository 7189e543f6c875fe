// Nacre: widgets for the knobs of the table.
#include "app/viewer/panel/knob_widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <variant>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_names.hpp"
#include "app/viewer/scene/view_defaults.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/run/shown_colours.hpp"
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
  if (!(knob.or_zero && value == 0)) value = int(std::clamp(double(value), knob.min, knob.max));
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

/// "#rrggbb" as a swatch to click on, and the text beside it; empty: the default.
void colour_widget(std::string& value) {
  const std::optional<std::array<float, 3>> now = hex_colour(value);
  std::array<float, 3> colour = now.value_or(std::array{0.5f, 0.5f, 0.5f});
  const auto flags = ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoAlpha;
  if (ImGui::ColorEdit3("##swatch", colour.data(), flags)) {
    const auto byte = [](float c) { return int(std::lround(255 * std::clamp(c, 0.0f, 1.0f))); };
    value = fmt::format("#{:02x}{:02x}{:02x}", byte(colour[0]), byte(colour[1]), byte(colour[2]));
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x - 1.5f * ImGui::GetFontSize());
  let_go(value, [](std::string& shown) { ImGui::InputTextWithHint("##value", "of the map", &shown); });
  if (!value.empty() && !hex_colour(value)) value.clear();  // what is no colour
}

void text_widget(std::string& value) {
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
    choice->set(choice->member, int(chosen - knob.choices.begin()));
  }
  if (auto* const* string = std::get_if<std::string*>(&knob.value)) {
    if (knob.name == "color_below" || knob.name == "color_above" || knob.name == "color_nan")
      colour_widget(**string);
    else if (knob.name == "colormap")
      choice_widget(**string, colormap_names());
    else if (!knob.choices.empty() || !choices.empty())
      choice_widget(**string, knob.choices.empty() ? choices : knob.choices);
    else
      text_widget(**string);
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

/// What it does, in which unit, what a change costs; `job` empty: it belongs to the view.
void explain(const Knob& knob, const std::string& job, bool changed, const std::string& usual) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  text(knob.help + (knob.unit.empty() ? "" : " (" + knob.unit + ")"));
  if (!job.empty()) ImGui::TextDisabled("%s: %s", knob.name.c_str(), knob_cost(knob.name, job).c_str());
  if (changed) text(usual.empty() ? "right click: empty again" : "right click: " + usual + " again");
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void show(Settings& settings, const Knob& knob, const std::vector<std::string>& choices = {},
          const std::string& job = "") {
  ImGui::PushID(knob.name.c_str());
  const std::string usual = default_text(knob);
  const bool changed = knob.text() != usual;
  ImGui::BeginGroup();  // the field and its name are one thing to the mouse
  ImGui::SetNextItemWidth((job.empty() ? 0.5f : 0.42f) * ImGui::GetContentRegionAvail().x);  // plain names are longer
  value_widget(knob, choices);
  ImGui::SameLine();
  const std::string plain = job.empty() ? "" : plain_name(knob.name),
                    unit = knob.unit.empty() ? "" : " [" + knob.unit + "]";
  text((changed ? "* " : "") + (plain.empty() ? knob.name + unit : plain + " (" + knob.name + ")"));
  ImGui::EndGroup();
  if (ImGui::IsItemHovered() && !ImGui::IsAnyItemActive()) explain(knob, job, changed, usual);
  if (changed && ImGui::IsItemClicked(1)) set_knob(settings, knob.name, usual);
  keep_sizes_in_order(settings, knob.name);
  ImGui::PopID();
}

}  // namespace

void knob_widget(Settings& settings, const std::string& name, const std::vector<std::string>& choices) {
  for (const Knob& knob : knobs(settings))
    if (knob.name == name) return show(settings, knob, choices);
}

static bool matches(const Knob& knob, const std::string& filter) {
  const auto lower = [](std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
  };
  const std::string wanted = lower(filter);
  for (const std::string& candidate : {knob.name, knob.help, plain_name(knob.name)})
    if (lower(candidate).find(wanted) != std::string::npos) return true;
  return false;
}

void knob_groups(Settings& settings, const std::string& job, const std::string& filter) {
  const std::vector<Knob> table = knobs(settings);
  const std::vector<std::string>& basic = basic_knobs(job);
  const bool searches = !filter.empty();
  if (!searches) {
    for (const std::string& name : basic)
      for (const Knob& knob : table)
        if (knob.name == name) show(settings, knob, {}, job);
    ImGui::Spacing();
    if (!ImGui::CollapsingHeader("Advanced")) return;
    ImGui::Indent();
  }
  std::string group;
  bool open = false;
  for (const Knob& knob : table) {
    if (!knob.concerns(job) || knob.group == "picture" || knob.group == "frames") continue;
    if (searches ? !matches(knob, filter) : std::find(basic.begin(), basic.end(), knob.name) != basic.end()) continue;
    if (knob.group != group) {
      group = knob.group;
      open = ImGui::CollapsingHeader(group.c_str(), ImGuiTreeNodeFlags_DefaultOpen);
    }
    if (open) show(settings, knob, {}, job);
  }
  if (!searches) ImGui::Unindent();
}

void reset_knobs(Settings& settings, const std::string& job) {
  for (const Knob& knob : knobs(settings)) {
    const bool data = knob.name == "vectors" || knob.name == "color" || knob.group == "case" ||
                      knob.group == "materials" || knob.group == "labels";
    if (knob.concerns(job) && knob.group != "picture" && !data) set_knob(settings, knob.name, default_text(knob));
  }
}

}  // namespace nacre
