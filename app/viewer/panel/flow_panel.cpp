// Nacre: a flow in the panel.
#include "app/viewer/panel/flow_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "engine/render/camera_motion.hpp"
#include "engine/run/flow_maps.hpp"
#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/prepare.hpp"

namespace nacre {
namespace {

/// Goes to a critical point, to the side of the surface that it can be seen from.
void look_at(const CriticalPoint& point, const TriangleTree& tree, std::optional<Camera>& camera) {
  if (!camera || point.triangle >= tree.triangles().size()) return;
  const Triangle& t = tree.triangles()[point.triangle];
  const Vec3d a = tree.points()[t.a], n = cross(tree.points()[t.b] - a, tree.points()[t.c] - a);
  const Vec3d normal = length(n) > 0 ? normalized(n) : n, back = normalized(camera->eye - camera->target);
  const double distance = length(camera->eye - camera->target), slack = 1e-4 * distance;
  const auto seen_along = [&](const Vec3d& direction) {
    return approach(*camera, point.position, direction, normal, 0.15 * distance);
  };
  const auto hidden = [&](const Camera& from) {
    return tree.first(point.position, -from.forward(), slack).has_value();
  };
  const Camera here = seen_along(back), beyond = seen_along(back - normal * (2 * dot(normal, back)));
  camera = hidden(here) && !hidden(beyond) ? beyond : here;
}

std::string range_text(const Range& range) { return fmt::format("{:.7g}:{:.7g}", range.low, range.high); }

}  // namespace

std::vector<std::string> flow_choices(const FlowOffer& offer, const std::string& knob) {
  std::vector<std::string> all;
  if (knob == "vectors") {
    all = offer.vectors;
    all.insert(all.begin(), "");  // the likeliest
    for (const std::string& field : analytic_vector_names()) all.push_back(field);
  } else if (knob == "color") {
    all = offer.arrays;
    all.insert(all.begin(), {"speed", "none", "FTLE"});
  }
  return all;
}

/// True where they were changed and let go, and are a range.
bool FlowPanel::edit_range(const char* label, RangeEdit& edit, const Range& now) {
  if (!edit.active) edit.ends = {now.low, now.high};
  ImGui::InputScalarN(label, ImGuiDataType_Double, edit.ends.data(), 2, nullptr, nullptr, "%.7g");
  edit.active = ImGui::IsItemActive();
  const auto [low, high] = edit.ends;
  return ImGui::IsItemDeactivatedAfterEdit() && std::isfinite(low) && std::isfinite(high) && low < high;
}

void FlowPanel::data_tab(Session& session) {
  knob_widget(session.settings, "vectors", flow_choices(results_.offer, "vectors"));
  if (ImGui::CollapsingHeader("colours", ImGuiTreeNodeFlags_DefaultOpen)) colours(session);
  if (!results_.tree || results_.corners.empty()) return;
  const Vec3d size = Extent(results_.corners).size();
  ImGui::Separator();
  text(fmt::format("{} triangles, {} points", grouped((long long)results_.tree->triangles().size()),
                   grouped((long long)results_.tree->points().size())));
  text(fmt::format("{:.4g} x {:.4g} x {:.4g} in the data's unit", size.x, size.y, size.z));
  const Range& time = results_.data.time;
  if (time.high > time.low) text(fmt::format("time {} to {}", time_text(time.low), time_text(time.high)));
}

void FlowPanel::look_tab(Session& session) {
  for (const char* name : {"fps", "contrast", "edges", "boxes", "isolines", "arrows", "arrow_count", "arrow_length",
                           "topology", "persistence", "tracks", "streamlines", "line_spacing"})
    knob_widget(session.settings, name);
  if (!ImGui::CollapsingHeader("dye", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (const char* name : {"dye", "dye_release", "dye_diffusion"}) knob_widget(session.settings, name);
  ImGui::TextDisabled("r: release dye at the point under the cursor");
  if (!session.settings.dye.empty() && ImGui::Button("remove all dye")) session.settings.dye.clear();
}

void FlowPanel::result_tab(Session& session) {
  if (results_.data.array.empty()) return text("nothing read yet");
  ImGui::PushID("flow");                            // the rest of the panel has a "play", too
  ImGui::PushItemWidth(-9 * ImGui::GetFontSize());  // room for a label and a button
  show_time(session);
  ImGui::PopItemWidth();
  ImGui::PopID();
  show_vectors();
  show_probes(session);
  if (results_.lines && session.settings.topology) critical_points(session);
  if (results_.embedding) show_embedding();
}

void FlowPanel::show_time(Session& session) {
  Settings& settings = session.settings;
  const FlowSpan& span = results_.span;
  text(fmt::format("time {}   step {}", time_text(results_.time), results_.steps));
  if (!(results_.data.time.high > results_.data.time.low)) return text("steady: one time only");
  if (edit_range("time", time_edit_, {span.first, span.end})) settings.time = range_text(time_edit_.range());
  ImGui::SameLine();
  if (ImGui::Button("all")) settings.time.clear();
}

/// The colour editor: the map, what it spans and how, and what lies beyond.
void FlowPanel::colours(Session& session) {
  Settings& settings = session.settings;
  for (const char* name : {"color", "colormap"}) knob_widget(settings, name, flow_choices(results_.offer, name));
  if (is_ftle(settings.color)) knob_widget(settings, "ftle_time");
  if (results_.data.color == "none") return;
  ImGui::PushID("colours");
  ImGui::PushItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
  std::string& knob = settings.color_range;
  const ColourRange& range = results_.colours.range;
  const bool percentiles = knob.ends_with('%');
  const char* kind = knob.empty() ? "of the data" : percentiles ? "percentiles" : "by hand";
  if (ImGui::BeginCombo("range", kind)) {
    if (ImGui::Selectable("of the data", knob.empty())) knob.clear();
    if (ImGui::Selectable("percentiles", percentiles)) knob = "2%:98%";
    if (ImGui::Selectable("by hand", !knob.empty() && !percentiles)) knob = range_text({range.low, range.high});
    ImGui::EndCombo();
  }
  if (edit_range("from, to", colours_edit_, {range.low, range.high})) knob = range_text(colours_edit_.range());
  if (percentiles) knob_widget(settings, "color_range");
  ImGui::PopItemWidth();
  ImGui::PopID();
  for (const char* name : {"color_symmetric", "color_scale", "color_below", "color_above", "color_nan"})
    knob_widget(settings, name);
}

void FlowPanel::show_vectors() const {
  const VectorStatistics& s = results_.data.statistics;
  ImGui::Separator();
  text(fmt::format("{} ({})", results_.data.array, results_.data.reason));
  text(fmt::format("speed: most {:.4g}, 98% below {:.4g}", s.max_speed, s.percentile_98));
  text(fmt::format("normal to the surface {:.1f}%   zero {:.1f}%", 100 * s.normal_share, 100 * s.zero_share));
}

/// What is at each point through time, with a line where the shown time is.
void FlowPanel::show_probes(Session& session) const {
  if (session.settings.probe.empty()) return;
  if (!ImGui::CollapsingHeader("points through time", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (std::size_t k = 0; k < results_.probes.size(); ++k) {
    const FlowProbe& probe = results_.probes[k];
    const Vec3d& p = probe.position;
    ImGui::PushID(int(k));
    text(fmt::format("{:.4g} {:.4g} {:.4g}", p.x, p.y, p.z));
    plot(probe.times, probe.speeds, "speed");
    const bool more = !probe.scalars.empty() && results_.data.color != "speed";
    if (more) plot(probe.times, probe.scalars, results_.data.color);
    ImGui::PopID();
  }
  if (ImGui::Button("remove the points")) session.settings.probe.clear();
}

void FlowPanel::plot(const std::vector<double>& times, const std::vector<float>& values,
                     const std::string& name) const {
  if (times.size() < 2) return text(fmt::format("{} {:.4g}, at all times", name, values.front()));
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 4 * ImGui::GetFontSize();
  text(fmt::format("{}: {:.4g} to {:.4g}", name, *low, *high));
  const ImVec2 top(corner.x, corner.y + ImGui::GetTextLineHeightWithSpacing());
  const double span = times.back() - times.front(), range = std::max(double(*high) - double(*low), 1e-30);
  const auto x_of = [&](double t) { return top.x + float((t - times.front()) / span) * width; };
  std::vector<ImVec2> line;  // at the data's own times, which need not be evenly spaced
  for (std::size_t i = 0; i < times.size(); ++i)
    line.push_back({x_of(times[i]), top.y + height * float(0.95 - 0.9 * (double(values[i]) - double(*low)) / range)});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 bottom(top.x + width, top.y + height);
  list.AddRectFilled(top, bottom, ImGui::GetColorU32(ImGuiCol_FrameBg));
  list.AddPolyline(line.data(), int(line.size()), ImGui::GetColorU32(ImGuiCol_PlotLines), 0, 1.5f);
  const float now = std::clamp(x_of(results_.time), top.x, bottom.x);
  list.AddLine({now, top.y}, {now, bottom.y}, ImGui::GetColorU32(ImGuiCol_PlotHistogram), 1);
  ImGui::Dummy({width, height});
}

/// The points of the time that is shown, the most persistent first; one that is clicked is looked at.
void FlowPanel::critical_points(Session& session) const {
  const std::vector<CriticalPoint>& points = results_.lines->skeleton.topology.points;
  const std::string title = fmt::format("{} critical points###critical points", points.size());
  if (!ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
  const FlowTopology& all = results_.lines->skeleton.topology;
  std::string sum = fmt::format("indices {}", all.point_index);
  if (!all.zero_regions.empty()) sum += fmt::format(", still regions {}", all.region_index);
  if (all.rims > 0) sum += fmt::format(", rims {}", all.rim_index);
  text(fmt::format("{}; Euler characteristic {}", sum, all.euler_characteristic));
  std::vector<const CriticalPoint*> order;
  for (const CriticalPoint& point : points) order.push_back(&point);
  std::stable_sort(order.begin(), order.end(),
                   [](const CriticalPoint* a, const CriticalPoint* b) { return a->persistence > b->persistence; });
  constexpr float most_rows = 8;
  const float rows = std::min(most_rows, float(order.size()));
  if (!ImGui::BeginChild("critical points", ImVec2(0, rows * ImGui::GetTextLineHeightWithSpacing()))) {
    ImGui::EndChild();
    return;
  }
  ImGuiListClipper clipper;  // hundreds of rows, of which a few are seen
  clipper.Begin(int(order.size()));
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) {
      const CriticalPoint& point = *order[std::size_t(k)];
      const std::string line = fmt::format("{}   persistence {:.3g}##{}", name_of(point.kind), point.persistence, k);
      if (ImGui::Selectable(line.c_str())) look_at(point, *results_.tree, session.camera);
    }
  ImGui::EndChild();
}

void FlowPanel::show_embedding() const {
  const EmbeddingInfo& e = *results_.embedding;
  ImGui::Separator();
  text(fmt::format("{} of {} x {} x {}", e.kind, e.dimensions.x, e.dimensions.y, e.dimensions.z));
  text(fmt::format("{} cells, {} on the surface", grouped((long long)e.cells), grouped((long long)e.surface_cells)));
  text(fmt::format("{:.1f} bytes a cell, {:.2f}% sparse", double(e.bytes) / double(std::max<std::uint64_t>(1, e.cells)),
                   100 * (1 - double(e.bytes) / std::max(1.0, double(e.dense_bytes)))));
  const std::vector<float>& seconds = results_.step_seconds;
  if (seconds.empty()) return;
  const float most = *std::max_element(seconds.begin(), seconds.end());
  text(fmt::format("{:.3f} s the last step", seconds.back()));
  ImGui::PlotLines("##steps", seconds.data(), int(seconds.size()), 0, nullptr, 0, 1.1f * most,
                   ImVec2(ImGui::GetContentRegionAvail().x, 48));
}

}  // namespace nacre
