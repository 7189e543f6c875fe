// Nacre: a mesh in the panel.
#include "app/viewer/panel/mesh_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "app/viewer/panel/volume_facts.hpp"
#include "engine/render/camera_motion.hpp"

namespace nacre {
namespace {

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

void plot(const char* id, const std::string& label, const std::vector<float>& values) {
  if (values.empty()) return;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  ImGui::PlotLines(id, values.data(), int(values.size()), 0, label.c_str(), *low, *high,
                   ImVec2(ImGui::GetContentRegionAvail().x, 60));
}

void particle_figures(const MeshResults& results) {
  if (!ImGui::CollapsingHeader("particles", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const MeshInfo& info = results.info;
  if (info.expected_particles <= 0) return text("none yet: the sizing field comes first");
  figures("particles", [&] {
    row("expected", grouped((long long)info.expected_particles));
    row("on points, curves", fmt::format("{}, {}", grouped(results.counts.points), grouped(results.counts.curves)));
    row("on surfaces", grouped(results.counts.surfaces));
    row("sizes, voxels", fmt::format("{:.3g} to {:.3g}", info.smallest_size, info.largest_size));
    if (info.final_energy > 0) row("mean energy", fmt::format("{:.4f}", info.final_energy));
  });
  if (results.energy.empty()) return;
  plot("##energy", fmt::format("energy {:.4f}", results.energy.back()), results.energy);
  plot("##count", grouped((long long)results.particles.back()) + " particles", results.particles);
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
    row("vertices, triangles", fmt::format("{}, {}", grouped((long long)t.vertices), grouped((long long)t.triangles)));
    row("components", fmt::format("{}", t.components));
    row("boundary edges", fmt::format("{}", t.boundary_edges));
    row("non-manifold edges", fmt::format("{}", t.nonmanifold_edges));
    row("junction edges", fmt::format("{}", t.junction_edges));
    row("sound", t.sound() ? "yes" : "no");
  });
}

/// Looks at a triangle from near: from where the camera is, but from in front of it where that is along its plane, and
/// from outside where the outside is on one of its sides.
void look_at(const SurfaceMesh& mesh, std::uint32_t triangle, std::optional<Camera>& camera) {
  if (!camera) return;
  const Triangle& t = mesh.triangles[triangle];
  const Vec3d a = mesh.points[t.a], b = mesh.points[t.b], c = mesh.points[t.c];
  const double edge = std::max({length(b - a), length(c - b), length(a - c)});
  Vec3d normal = cross(b - a, c - a), back = normalized(camera->eye - camera->target);
  if (length(normal) > 0) {
    normal = normalized(normal);  // to the side of the first material
    const bool outer = mesh.materials[triangle][0] == 0;
    if (outer && dot(normal, back) < 0) back = back - normal * (2 * dot(normal, back));
  }
  camera = approach(*camera, (a + b + c) / 3.0, back, normal, 12 * edge);
}

void worst_list(const MeshResults& results, Session& session) {
  if (!ImGui::CollapsingHeader("worst triangles", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::SliderInt("highlight", &session.settings.view.worst, 0, 100);
  const std::size_t listed = std::min<std::size_t>(results.measures->worst.size(), 20);
  for (std::size_t k = 0; k < listed; ++k) {
    const WorstTriangle& worst = results.measures->worst[k];
    const auto& pair = results.mesh->materials[worst.triangle];
    const MeshInput& input = results.volume->input;
    const std::string line = fmt::format("{:.3f}  {} | {}##{}", worst.radius_ratio, material_name(input, pair[0]),
                                         material_name(input, pair[1]), k);
    if (!ImGui::Selectable(line.c_str())) continue;
    look_at(*results.mesh, worst.triangle, session.camera);
    int& highlighted =
        session.settings.view.worst;  // otherwise it could not be distinguished from its neighbours, nor seen inside
    highlighted = std::max(highlighted, int(k) + 1);
  }
}

}  // namespace

void MeshPanel::data_tab(Session& session) {
  for (const char* name : {"labels", "isovalue", "threshold", "materials", "merge", "min_component"})
    knob_widget(session.settings, name);
  if (results_.volume) draw_volume_facts(*results_.volume, session);
}

void MeshPanel::look_tab(Session& session) {
  for (const char* name : {"preview", "triangles", "edges", "show_particles", "particle_color", "curves", "boxes",
                           "hidden", "ghosts", "opacity", "material_colors", "worst", "slice", "slice_at",
                           "slice_field", "slice_range", "layout", "crosshair"})
    knob_widget(session.settings, name);
}

void MeshPanel::result_tab(Session& session) {
  if (!results_.volume) return;
  const bool measured = results_.measures && results_.mesh;
  if (!measured) particle_figures(results_);
  materials_.draw(results_, session.settings.view);
  if (!measured) return;
  quality_figures(*results_.measures);
  worst_list(results_, session);
  topology_figures(results_.measures->topology);
  particle_figures(results_);
}

}  // namespace nacre
