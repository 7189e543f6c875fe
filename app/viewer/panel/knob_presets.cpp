// Nacre: presets.
#include "app/viewer/panel/knob_presets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/scene/view_defaults.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

fs::path configuration_folder() {
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config == '/') return fs::path(config) / "nacre";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? fs::path(home) / ".config/nacre" : fs::path();
}

/// What names the data, not how they are treated.
bool names_data(const Knob& knob) {
  constexpr const char* names[] = {"vectors", "time", "begin_at", "names", "layer", "camera"};
  return knob.group == "labels" || knob.group == "materials" || knob.group == "view" ||
         std::find(std::begin(names), std::end(names), knob.name) != std::end(names);
}

/// What is no preset is left out: the folder is the user's.
std::vector<KnobPreset> presets_in(const fs::path& folder) {
  std::vector<KnobPreset> presets;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream stream(entry.path());
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    if (!json.is_object() || !json.contains("job") || !json["job"].is_string() || !json.contains("knobs")) continue;
    KnobPreset preset{entry.path().stem().string(), json["job"], "your own", {}};
    for (const auto& [knob, value] : json["knobs"].items())
      if (value.is_string()) preset.knobs[knob] = value;
    presets.push_back(std::move(preset));
  }
  std::sort(presets.begin(), presets.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return presets;
}

}  // namespace

const std::vector<KnobPreset>& built_in_presets() {
  static const std::vector<KnobPreset> all{
      {"draft", "flow", "coarse texture, moves soon", {{"resolution", "256"}, {"warmup", "2"}}},
      {"standard", "flow", "as the viewer begins", {{"resolution", "512"}, {"warmup", "-1"}}},
      {"best", "flow", "fine texture, for pictures", {{"resolution", "2048"}, {"warmup", "-1"}}},
      {"wall shear",
       "flow",
       "warm colours up to the 98th percentile, so that a few peaks do not hide the rest",
       {{"color", "speed"}, {"colormap", "ember"}, {"color_range", "0%:98%"}, {"color_scale", "linear"}}},
      {"wind",
       "flow",
       "many colours over all speeds, long streaks",
       {{"color", "speed"}, {"colormap", "turbo"}, {"color_range", "0%:100%"}, {"ttl", "8"}}},
      {"currents",
       "flow",
       "slow and fast water: speeds on a logarithmic scale, displacements nearly equal",
       {{"color", "speed"},
        {"colormap", "sea"},
        {"color_range", "2%:100%"},
        {"color_scale", "log"},
        {"speed_power", "0.5"}}},
      {"draft",
       "mesh",
       "large triangles, few iterations",
       {{"min_size", "1.5"}, {"max_size", "4"}, {"iterations", "20"}}},
      {"standard",
       "mesh",
       "as the viewer begins",
       {{"min_size", "0.5"}, {"max_size", "1"}, {"iterations", "70"}, {"remesh", "12"}}},
      {"best",
       "mesh",
       "small triangles where the body is curved, until nothing moves any more",
       {{"min_size", "0.4"}, {"max_size", "1"}, {"epsilon", "0.35"}, {"iterations", "200"}, {"remesh", "30"}}},
  };
  return all;
}

void apply_preset(const KnobPreset& preset, Settings& settings) {
  Settings tried = settings;
  for (const auto& [knob, value] : preset.knobs) set_knob(tried, knob, value);
  settings = tried;
}

KnobPresets::KnobPresets()
    : KnobPresets(configuration_folder().empty() ? fs::path() : configuration_folder() / "presets") {}

KnobPresets::KnobPresets(fs::path folder) : folder_(std::move(folder)) { read(); }

void KnobPresets::read() { own_ = folder_.empty() ? std::vector<KnobPreset>{} : presets_in(folder_); }

std::vector<KnobPreset> KnobPresets::of(const std::string& job) const {
  std::vector<KnobPreset> found;
  for (const std::vector<KnobPreset>* list : {&built_in_presets(), &own_})
    for (const KnobPreset& preset : *list)
      if (preset.job == job) found.push_back(preset);
  return found;
}

void KnobPresets::save(const std::string& name, const std::string& job, Settings& settings) {
  if (folder_.empty()) throw Error("the preset was not saved", "there is no home folder");
  if (name.empty() || name.find_first_of("/\\") != std::string::npos || name[0] == '.')
    throw Error(fmt::format("'{}' is no name for a preset", name), "it becomes the name of a file");
  Settings usual = view_defaults();
  const std::vector<Knob> before = knobs(usual);
  nlohmann::json json{{"job", job}, {"knobs", nlohmann::json::object()}};
  const std::vector<Knob> now = knobs(settings);
  for (std::size_t k = 0; k < now.size(); ++k)
    if (now[k].concerns(job) && !names_data(now[k]) && now[k].text() != before[k].text())
      json["knobs"][now[k].name] = now[k].text();
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  OutputFile out(folder_ / (name + ".json"));
  out.write(json.dump(2) + "\n");
  out.commit();
  read();
}

void KnobPresets::draw(Settings& settings, const std::string& job) {
  if (ImGui::BeginCombo("##presets", "presets")) {
    try {
      for (const KnobPreset& preset : of(job)) {
        if (ImGui::Selectable(preset.name.c_str())) trouble_.clear(), apply_preset(preset, settings);
        if (!ImGui::IsItemHovered()) continue;
        std::string tip = preset.help;
        for (const auto& [knob, value] : preset.knobs) tip += fmt::format("\n{} = {}", knob, value);
        ImGui::SetTooltip("%s", tip.c_str());
      }
      ImGui::Separator();
      ImGui::SetNextItemWidth(10 * ImGui::GetFontSize());
      const bool typed = ImGui::InputTextWithHint("##name", "name", &name_, ImGuiInputTextFlags_EnterReturnsTrue);
      ImGui::SameLine();
      if ((ImGui::Button("save these knobs") || typed) && !name_.empty()) {
        save(name_, job, settings);
        name_.clear();
        ImGui::CloseCurrentPopup();
      }
    } catch (const Error& error) {
      trouble_ = error.what();
    }
    if (!trouble_.empty()) text("! " + trouble_);
    ImGui::EndCombo();
  }
}

}  // namespace nacre
