// Nacre: the list of a mesh's materials.
#include "app/viewer/panel/material_list.hpp"

#include <fmt/ranges.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "app/viewer/panel/imgui_text.hpp"
#include "engine/picture/material_colours.hpp"

namespace nacre {
namespace {

constexpr std::size_t few = 12;                                ///< materials that are seen at a glance
constexpr const char* volume_head = "volume, unit³###volume";  ///< of a mesh, in the data's unit of length

using Labels = std::set<std::int64_t>;

Labels set_of(const std::string& words) {
  const std::vector<std::int64_t> labels = labels_of(words);
  return {labels.begin(), labels.end()};
}

enum class Seen { solid, ghost, hidden };

/// The two knobs of the look as sets, and back.
struct Sight {
  Labels hidden, ghosts;

  void set(std::int64_t label, Seen seen) {
    hidden.erase(label);
    if (seen == Seen::hidden) return void(hidden.insert(label));  // a ghost that is hidden comes back as one
    ghosts.erase(label);
    if (seen == Seen::ghost) ghosts.insert(label);
  }
  void store(ViewSettings& look) const {
    look.hidden = fmt::format("{}", fmt::join(hidden, ","));
    look.ghosts = fmt::format("{}", fmt::join(ghosts, ","));
  }
};

std::string lower_case(std::string words) {
  for (char& c : words) c = char(std::tolower(static_cast<unsigned char>(c)));
  return words;
}

/// What the column "volume" has: voxels until there is a mesh to be measured.
double volume_of(const MeshResults& results, std::size_t m) {
  const bool measured = results.measures && m < results.measures->topology.materials.size();
  return measured ? results.measures->topology.materials[m].volume : double(results.volume->input.voxels[m]);
}

std::string volume_words(const MeshResults& results, std::size_t m) {
  if (!results.measures || m >= results.measures->topology.materials.size())
    return grouped((long long)results.volume->input.voxels[m]);
  const MaterialTopology& t = results.measures->topology.materials[m];
  const std::string size = t.volume >= 1e3 ? grouped(std::llround(t.volume)) : fmt::format("{:.4g}", t.volume);
  return size + (t.facets == 0 ? " lost" : t.closed ? "" : " open");
}

/// Of the column; it is known before the rows are drawn.
float volume_width(const std::vector<std::size_t>& rows, const MeshResults& results) {
  float widest =
      ImGui::CalcTextSize(volume_head, nullptr, true).x + 1.2f * ImGui::GetFontSize();  // and the arrow of the order
  for (std::size_t k = 0; k < std::min<std::size_t>(rows.size(), 500); ++k)
    widest = std::max(widest, ImGui::CalcTextSize(volume_words(results, rows[k]).c_str()).x);
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

/// As wide as the longer of its two words, so that nothing moves under the mouse.
bool button(const char* label, const char* widest) {
  return ImGui::Button(label, ImVec2(ImGui::CalcTextSize(widest).x + 2 * ImGui::GetStyle().FramePadding.x, 0));
}

/// Its buttons, in the room of one line.
void row_buttons(const MeshInput& input, std::size_t m, Sight& sight) {
  const std::int64_t label = input.labels[m];
  const bool hidden = sight.hidden.contains(label), ghost = sight.ghosts.contains(label);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ImGui::GetStyle().FramePadding.x, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImGui::GetStyle().ItemInnerSpacing);
  if (button(hidden ? "show" : "hide", "show"))
    sight.set(label, !hidden ? Seen::hidden : ghost ? Seen::ghost : Seen::solid);
  ImGui::SameLine();
  if (button(ghost ? "solid" : "ghost", "ghost"))
    ghost ? void(sight.ghosts.erase(label)) : void(sight.ghosts.insert(label));
  ImGui::SameLine();
  if (button("only", "only")) {
    for (std::size_t other = 1; other < input.labels.size(); ++other)
      sight.set(input.labels[other], other == m ? Seen::solid : Seen::hidden);
    sight.ghosts.clear();
  }
  ImGui::PopStyleVar(2);
}

void row(const MeshResults& results, std::size_t m, Sight& sight) {
  const MeshInput& input = results.volume->input;
  const Color c = material_colour(int(m));
  const float line = ImGui::GetTextLineHeight();
  const bool hidden = sight.hidden.contains(input.labels[m]);
  ImGui::PushID(int(m));
  ImGui::TableNextColumn();
  ImGui::ColorButton("##colour", ImVec4(c[0], c[1], c[2], 1), ImGuiColorEditFlags_NoTooltip, ImVec2(line, line));
  ImGui::SameLine();
  if (hidden) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  const std::string name = material_name(input, m);
  const bool cut = ImGui::CalcTextSize(name.c_str()).x > ImGui::GetContentRegionAvail().x;
  text(name);
  if (hidden) ImGui::PopStyleColor();
  if (cut && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", name.c_str());
  ImGui::TableNextColumn();
  text(volume_words(results, m));
  ImGui::TableNextColumn();
  row_buttons(input, m, sight);
  ImGui::PopID();
}

void table(const MeshResults& results, std::vector<std::size_t> rows, Sight& sight) {
  const bool many = results.volume->input.labels.size() > few + 1;
  const float row_height = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const auto flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_Sortable;
  const ImVec2 size(0, many ? (float(few) + 1.5f) * row_height : 0);  // half a row says that there are more
  if (!ImGui::BeginTable("materials", 3, flags | (many ? ImGuiTableFlags_ScrollY : 0), size)) return;
  ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn(results.measures ? volume_head : "voxels###volume",
                          ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending,
                          volume_width(rows, results));
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_NoSort);
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableHeadersRow();
  sort_rows(rows, results);
  ImGuiListClipper clipper;
  clipper.Begin(int(rows.size()), row_height);
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) row(results, rows[std::size_t(k)], sight);
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

void MaterialList::draw(const MeshResults& results, ViewSettings& look) {
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
  Sight sight{set_of(look.hidden), set_of(look.ghosts)};
  const Sight before = sight;
  const auto for_all = [&](const char* words, Seen seen) {
    if (ImGui::Button(words))
      for (const std::size_t m : rows) sight.set(input.labels[m], seen);
    ImGui::SameLine();
  };
  for_all("show", Seen::solid);
  for_all("hide", Seen::hidden);
  for_all("ghost", Seen::ghost);
  text(wanted_.empty() ? "all" : "these");
  table(results, rows, sight);
  if (sight.hidden != before.hidden || sight.ghosts != before.ghosts) sight.store(look);
}

}  // namespace nacre
