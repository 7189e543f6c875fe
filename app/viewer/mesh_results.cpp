// Nacre: the tab "result" of a mesh.
#include "app/viewer/mesh_results.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <sstream>

#include "engine/picture/material_colours.hpp"

namespace nacre {
namespace {

void text(const std::string& words) { ImGui::TextUnformatted(words.data(), words.data() + words.size()); }

void row(const char* name, const std::string& value) {
  ImGui::TableNextColumn();
  text(name);
  ImGui::TableNextColumn();
  text(value);
}

template <class Rows>
void figures(const char* id, const Rows& rows) {
  if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchSame)) return;
  rows();
  ImGui::EndTable();
}

void plot(const char* id, const char* name, const std::vector<float>& values) {
  if (values.empty()) return;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const std::string label = fmt::format("{} {:.5g}", name, values.back());
  ImGui::PlotLines(id, values.data(), int(values.size()), 0, label.c_str(), *low, *high,
                   ImVec2(ImGui::GetContentRegionAvail().x, 60));
}

std::string words_of(const std::vector<std::int64_t>& labels) { return fmt::format("{}", fmt::join(labels, ",")); }

/// Adds a label to a list of words, or takes it out.
void toggle(std::string& words, std::int64_t label) {
  std::vector<std::int64_t> labels = labels_of(words);
  const auto found = std::find(labels.begin(), labels.end(), label);
  if (found != labels.end())
    labels.erase(found);
  else
    labels.push_back(label);
  words = words_of(labels);
}

bool holds(const std::string& words, std::int64_t label) {
  const std::vector<std::int64_t> labels = labels_of(words);
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

void show_only(Look& look, const std::vector<std::int64_t>& labels, std::size_t only) {
  std::vector<std::int64_t> hidden;
  for (std::size_t m = 1; m < labels.size(); ++m)
    if (m != only) hidden.push_back(labels[m]);
  look.hidden = words_of(hidden);
  look.ghosts.clear();
}

void material_row(const MeshResults& results, Look& look, std::size_t m) {
  const MeshInput& input = results.volume->input;
  const std::int64_t label = input.labels[m];
  const Color c = material_colour(int(m));
  ImGui::PushID(int(m));
  ImGui::TableNextColumn();
  ImGui::ColorButton("##colour", ImVec4(c[0], c[1], c[2], 1), ImGuiColorEditFlags_NoTooltip, ImVec2(14, 14));
  ImGui::SameLine();
  text(material_name(input, m));
  ImGui::TableNextColumn();
  if (results.measures && m < results.measures->topology.materials.size()) {
    const MaterialTopology& t = results.measures->topology.materials[m];
    text(fmt::format("{:.4g} {}", t.volume, t.facets == 0 ? "lost" : t.closed ? "closed" : "open"));
  } else {
    text(fmt::format("{} voxels", input.voxels[m]));
  }
  ImGui::TableNextColumn();
  if (ImGui::SmallButton(holds(look.hidden, label) ? "show" : "hide")) toggle(look.hidden, label);
  ImGui::SameLine();
  if (ImGui::SmallButton(holds(look.ghosts, label) ? "solid" : "ghost")) toggle(look.ghosts, label);
  ImGui::SameLine();
  if (ImGui::SmallButton("only")) show_only(look, input.labels, m);
  ImGui::PopID();
}

void materials_table(const MeshResults& results, Look& look) {
  if (!ImGui::CollapsingHeader("materials", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (ImGui::SmallButton("show all")) look.hidden.clear(), look.ghosts.clear();
  if (!ImGui::BeginTable("materials", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  for (const char* head : {"label", "volume", ""}) ImGui::TableSetupColumn(head);
  ImGui::TableHeadersRow();
  for (std::size_t m = 1; m < results.volume->input.labels.size(); ++m) material_row(results, look, m);
  ImGui::EndTable();
}

void particle_figures(const MeshResults& results) {
  if (!ImGui::CollapsingHeader("particles", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const MeshInfo& info = results.info;
  figures("particles", [&] {
    row("expected", fmt::format("{:.0f}", info.expected_particles));
    row("on points, curves", fmt::format("{}, {}", results.counts.points, results.counts.curves));
    row("on surfaces", fmt::format("{}", results.counts.surfaces));
    row("sizes, voxels", fmt::format("{:.3g} to {:.3g}", info.smallest_size, info.largest_size));
    if (info.final_energy > 0) row("mean energy", fmt::format("{:.4f}", info.final_energy));
  });
  plot("##energy", "energy", results.energy);
  plot("##count", "particles", results.particles);
}

void quality_figures(const MeshMeasures& measures) {
  if (!ImGui::CollapsingHeader("quality", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const TriangleQuality& q = measures.quality.all;
  std::array<float, 50> bins{};
  for (std::size_t k = 0; k < bins.size(); ++k) bins[k] = float(q.radius_ratio_histogram[k]);
  const std::string label =
      fmt::format("radius ratio {:.3f} mean, {:.3f} min", q.radius_ratio_mean, q.radius_ratio_min);
  ImGui::PlotHistogram("##ratios", bins.data(), int(bins.size()), 0, label.c_str(), 0,
                       *std::max_element(bins.begin(), bins.end()), ImVec2(ImGui::GetContentRegionAvail().x, 80));
  figures("quality", [&] {
    row("angles", fmt::format("{:.1f} to {:.1f} degrees", q.angle_min, q.angle_max));
    row("under 25 degrees", fmt::format("{:.2f}% of triangles", 100 * q.share_under_25));
    row("off the interface, voxels", fmt::format("{:.3f} mean, {:.2f} max", measures.distance.facet_mean,
                                                 std::max(measures.distance.vertex_max, measures.distance.facet_max)));
  });
}

void topology_figures(const TopologyReport& t) {
  if (!ImGui::CollapsingHeader("topology", ImGuiTreeNodeFlags_DefaultOpen)) return;
  figures("topology", [&] {
    row("vertices, triangles", fmt::format("{}, {}", t.vertices, t.triangles));
    row("components", fmt::format("{}", t.components));
    row("boundary edges", fmt::format("{}", t.boundary_edges));
    row("non-manifold edges", fmt::format("{}", t.nonmanifold_edges));
    row("junction edges", fmt::format("{}", t.junction_edges));
    row("sound", t.sound() ? "yes" : "no");
  });
}

/// Looks at a triangle from where the camera is, or from in front of it where that is along its plane, and from near.
void look_at(const SurfaceMesh& mesh, std::uint32_t triangle, std::optional<Camera>& camera) {
  if (!camera) return;
  const Triangle& t = mesh.triangles[triangle];
  const Vec3d a = mesh.points[t.a], b = mesh.points[t.b], c = mesh.points[t.c];
  const double edge = std::max({length(b - a), length(c - b), length(a - c)});
  Vec3d normal = cross(b - a, c - a), back = normalized(camera->eye - camera->target);
  if (length(normal) > 0) {
    normal = normalized(normal);
    const double facing = dot(normal, back);
    if (std::fabs(facing) < 0.3) back = normalized(back + normal * (facing < 0 ? -0.6 : 0.6));
  }
  const double nearer = std::min(1.0, 12 * edge / camera->height), distance = length(camera->eye - camera->target);
  camera->target = (a + b + c) / 3.0;
  camera->eye = camera->target + back * (distance * nearer);
  camera->height *= nearer;
}

void worst_list(const MeshResults& results, Session& session) {
  if (!ImGui::CollapsingHeader("worst triangles", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::SliderInt("highlight", &session.settings.look.worst, 0, 100);
  const std::size_t listed = std::min<std::size_t>(results.measures->worst.size(), 20);
  for (std::size_t k = 0; k < listed; ++k) {
    const WorstTriangle& worst = results.measures->worst[k];
    const auto& pair = results.mesh->materials[worst.triangle];
    const MeshInput& input = results.volume->input;
    const std::string line = fmt::format("{:.3f}  {} | {}##{}", worst.radius_ratio, material_name(input, pair[0]),
                                         material_name(input, pair[1]), k);
    if (ImGui::Selectable(line.c_str())) look_at(*results.mesh, worst.triangle, session.camera);
  }
}

}  // namespace

std::vector<std::int64_t> labels_of(const std::string& words) {
  std::vector<std::int64_t> labels;
  std::istringstream stream(words);
  for (std::string word; std::getline(stream, word, ',');) {
    std::istringstream number(word);
    std::int64_t label;
    if (number >> label) labels.push_back(label);
  }
  return labels;
}

std::string material_name(const MeshInput& input, std::size_t m) {
  if (m == 0) return "outside";
  const bool named = m < input.names.size() && !input.names[m].empty();
  return named ? fmt::format("{} {}", input.labels[m], input.names[m]) : fmt::format("{}", input.labels[m]);
}

void draw_mesh_results(const MeshResults& results, Session& session) {
  if (!results.volume) return;
  const bool measured = results.measures && results.mesh;
  if (!measured) particle_figures(results);
  materials_table(results, session.settings.look);
  if (!measured) return;
  quality_figures(*results.measures);
  worst_list(results, session);
  topology_figures(results.measures->topology);
  particle_figures(results);
}

}  // namespace nacre
