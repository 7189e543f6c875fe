// Nacre: the list of a mesh's materials.
#include "app/viewer/panel/material_list.hpp"

#include <fmt/ranges.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "app/viewer/panel/imgui_text.hpp"
#include "engine/run/material_palette.hpp"

namespace nacre {
namespace {

constexpr std::size_t few = 12;  ///< materials that are seen at a glance

using Labels = std::set<std::int64_t>;

Labels set_of(const std::string& line) {
  const std::vector<std::int64_t> labels = labels_of(line);
  return {labels.begin(), labels.end()};
}

/// In a cube of that unit; 0: nobody knows.
double millilitres(const std::string& unit) {
  return unit == "mm" ? 1e-3 : unit == "cm" ? 1 : unit == "m" ? 1e6 : unit == "um" || unit == "µm" ? 1e-12 : 0;
}

enum class Seen { solid, ghost, hidden };

/// The knobs of the look by label, and back.
struct Sight {
  Labels hidden, ghosts;
  std::map<std::int64_t, double> opacity;
  std::map<std::int64_t, Color> colours;
  bool operator==(const Sight&) const = default;

  explicit Sight(const ViewSettings& view)
      : hidden(set_of(view.hidden)),
        ghosts(set_of(view.ghosts)),
        opacity(parse_label_opacities(view.opacity)),
        colours(parse_label_colours(view.material_colors)) {}

  void set(std::int64_t label, Seen seen) {
    hidden.erase(label);
    if (seen == Seen::hidden) return void(hidden.insert(label));  // a ghost that is hidden comes back as one
    ghosts.erase(label);
    opacity.erase(label);
    if (seen == Seen::ghost) ghosts.insert(label);
  }
  double opacity_of(std::int64_t label) const {
    const auto own = opacity.find(label);
    return own != opacity.end() ? own->second : ghosts.contains(label) ? double(ghost_opacity) : 1;
  }
  void set_opacity(std::int64_t label, double value) {
    set(label, Seen::solid);
    if (value < 1) opacity[label] = value;
  }
  void store(ViewSettings& view) const {
    view.hidden = fmt::format("{}", fmt::join(hidden, ","));
    view.ghosts = fmt::format("{}", fmt::join(ghosts, ","));
    view.opacity = label_opacity_text(opacity);
    view.material_colors = label_colour_text(colours);
  }
};

std::string lower_case(std::string line) {
  for (char& c : line) c = char(std::tolower(static_cast<unsigned char>(c)));
  return line;
}

/// What the column "volume" has: voxels until there is a mesh to be measured.
double volume_of(const MeshResults& results, std::size_t m) {
  const bool measured = results.measures && m < results.measures->topology.materials.size();
  return measured ? results.measures->topology.materials[m].volume : double(results.volume->input.voxels[m]);
}

/// Of a mesh; in mL where the file has a unit that says how large one is.
std::string volume_head(const MeshResults& results) {
  if (!results.measures) return "voxels###volume";
  return (millilitres(results.volume->input.unit) > 0 ? "mL" : "volume, unit³") + std::string("###volume");
}

std::string size_text(double size) { return size >= 1e3 ? grouped(std::llround(size)) : fmt::format("{:.4g}", size); }

std::string volume_text(const MeshResults& results, std::size_t m) {
  if (!results.measures || m >= results.measures->topology.materials.size())
    return grouped((long long)results.volume->input.voxels[m]);
  const MaterialTopology& t = results.measures->topology.materials[m];
  const double unit = millilitres(results.volume->input.unit);
  return size_text(unit > 0 ? unit * t.volume : t.volume) + (t.facets == 0 ? " lost" : t.closed ? "" : " open");
}

/// What the column has no room for.
std::string size_details(const MeshResults& results, std::size_t m) {
  const MeshInput& input = results.volume->input;
  std::string line = grouped((long long)input.voxels[m]) + " voxels";
  if (!results.measures || m >= results.measures->area.size()) return line;
  const double ml = millilitres(input.unit), volume = results.measures->topology.materials[m].volume,
               area = results.measures->area[m];
  const std::string unit = input.unit.empty() ? "unit" : input.unit;
  line += fmt::format("\nvolume {} {}³", size_text(volume), unit);
  if (ml > 0) line += fmt::format(" = {} mL", size_text(ml * volume));
  line += fmt::format("\narea {} {}²", size_text(area), unit);
  if (ml > 0) line += fmt::format(" = {} cm²", size_text(std::pow(ml, 2.0 / 3) * area));
  return line;
}

/// Of the column; it is known before the rows are drawn.
float volume_width(const std::vector<std::size_t>& rows, const MeshResults& results) {
  float widest = ImGui::CalcTextSize(volume_head(results).c_str(), nullptr, true).x +
                 1.2f * ImGui::GetFontSize();  // and the arrow of the order
  for (std::size_t k = 0; k < std::min<std::size_t>(rows.size(), 500); ++k)
    widest = std::max(widest, ImGui::CalcTextSize(volume_text(results, rows[k]).c_str()).x);
  return widest;
}

/// By the column that the user has chosen.
void sort_rows(std::vector<std::size_t>& rows, const MeshResults& results) {
  const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (!specs || specs->SpecsCount == 0) return;
  const bool by_volume = specs->Specs[0].ColumnIndex == 1;
  const bool descends = specs->Specs[0].SortDirection == ImGuiSortDirection_Descending;
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    if (descends) std::swap(a, b);
    return by_volume ? volume_of(results, a) < volume_of(results, b) : a < b;
  });
}

/// As wide as the longer of its two texts, so that nothing moves under the mouse.
bool button(const char* label, const char* widest) {
  return ImGui::Button(label, ImVec2(ImGui::CalcTextSize(widest).x + 2 * ImGui::GetStyle().FramePadding.x, 0));
}

/// Its buttons, in the room of one line.
void row_buttons(const MeshInput& input, std::size_t m, Sight& sight) {
  const std::int64_t label = input.labels[m];
  const bool hidden = sight.hidden.contains(label);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ImGui::GetStyle().FramePadding.x, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImGui::GetStyle().ItemInnerSpacing);
  if (button(hidden ? "show" : "hide", "show"))
    hidden ? void(sight.hidden.erase(label)) : sight.set(label, Seen::hidden);
  ImGui::SameLine();
  double opacity = sight.opacity_of(label);
  constexpr double none = 0, solid = 1;
  ImGui::SetNextItemWidth(3.2f * ImGui::GetFontSize());
  if (ImGui::SliderScalar("##opacity", ImGuiDataType_Double, &opacity, &none, &solid, "%.1f",
                          ImGuiSliderFlags_AlwaysClamp))
    sight.set_opacity(label, opacity);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("opacity; 1: solid");
  ImGui::SameLine();
  if (button("only", "only")) {
    for (std::size_t other = 1; other < input.labels.size(); ++other)
      sight.set(input.labels[other], other == m ? Seen::solid : Seen::hidden);
    sight.ghosts.clear();
    sight.opacity.clear();
  }
  ImGui::PopStyleVar(2);
}

/// A click on it edits the colour; a right click gives the usual one again.
void swatch(std::int64_t label, Color colour, Sight& sight) {
  const float line = ImGui::GetTextLineHeight();
  constexpr const char* editor = "colour";
  const ImVec4 shown(colour[0], colour[1], colour[2], 1);
  if (ImGui::ColorButton("##colour", shown, ImGuiColorEditFlags_NoTooltip, ImVec2(line, line)))
    ImGui::OpenPopup(editor);
  if (ImGui::IsItemClicked(1)) sight.colours.erase(label);
  if (!ImGui::BeginPopup(editor)) return;
  if (ImGui::ColorPicker3("##picker", colour.data(), ImGuiColorEditFlags_NoSidePreview)) sight.colours[label] = colour;
  if (ImGui::Button("the usual one")) sight.colours.erase(label);
  ImGui::EndPopup();
}

void row(const MeshResults& results, const std::vector<Color>& palette, std::size_t m, Sight& sight) {
  const MeshInput& input = results.volume->input;
  const bool hidden = sight.hidden.contains(input.labels[m]);
  ImGui::PushID(int(m));
  ImGui::TableNextColumn();
  swatch(input.labels[m], palette[m], sight);
  ImGui::SameLine();
  if (hidden) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  const std::string name = material_name(input, m);
  const bool cut = ImGui::CalcTextSize(name.c_str()).x > ImGui::GetContentRegionAvail().x;
  text(name);
  if (hidden) ImGui::PopStyleColor();
  if (cut && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", name.c_str());
  ImGui::TableNextColumn();
  text(volume_text(results, m));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", size_details(results, m).c_str());
  ImGui::TableNextColumn();
  row_buttons(input, m, sight);
  ImGui::PopID();
}

void table(const MeshResults& results, std::vector<std::size_t> rows, const std::vector<Color>& palette, Sight& sight) {
  const bool many = results.volume->input.labels.size() > few + 1;
  const float row_height = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const auto flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_Sortable;
  const ImVec2 size(0, many ? (float(few) + 1.5f) * row_height : 0);  // half a row says that there are more
  if (!ImGui::BeginTable("materials", 3, flags | (many ? ImGuiTableFlags_ScrollY : 0), size)) return;
  ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn(volume_head(results).c_str(),
                          ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending,
                          volume_width(rows, results));
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_NoSort);
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableHeadersRow();
  sort_rows(rows, results);
  ImGuiListClipper clipper;
  clipper.Begin(int(rows.size()), row_height);
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) row(results, palette, rows[std::size_t(k)], sight);
  ImGui::EndTable();
}

}  // namespace

std::vector<std::size_t> MaterialList::found(const MeshInput& input) const {
  std::vector<std::size_t> all;
  for (std::size_t m = 1; m < input.labels.size(); ++m)
    if (wanted_.empty() || lower_case(material_name(input, m)).find(lower_case(wanted_)) != std::string::npos)
      all.push_back(m);
  return all;
}

void MaterialList::draw(const MeshResults& results, ViewSettings& view) {
  const MeshInput& input = results.volume->input;
  const std::string title = fmt::format("materials: {}###materials", grouped((long long)input.labels.size() - 1));
  if (!ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (input.labels.size() > few + 1) {
    ImGui::SetNextItemWidth(0.4f * ImGui::GetContentRegionAvail().x);
    ImGui::InputTextWithHint("##find", "find a material", &wanted_);
    ImGui::SameLine();
  } else {
    wanted_.clear();
  }
  const std::vector<std::size_t> rows = found(input);
  Sight sight(view);
  const Sight before = sight;
  const auto for_all = [&](const char* label, Seen seen) {
    if (ImGui::Button(label))
      for (const std::size_t m : rows) sight.set(input.labels[m], seen);
    ImGui::SameLine();
  };
  for_all("show", Seen::solid);
  for_all("hide", Seen::hidden);
  for_all("ghost", Seen::ghost);
  text(wanted_.empty() ? "all" : "these");
  table(results, rows, material_palette(input, view.material_colors), sight);
  if (sight != before) sight.store(view);
}

}  // namespace nacre
