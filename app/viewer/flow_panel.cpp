// Nacre: the result of a flow in the panel: embedding, pace, vectors, time, colours.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/flow_scene.hpp"
#include "app/viewer/words.hpp"
#include "engine/scene/surface/prepare.hpp"

namespace nacre {
namespace {

std::string words_of(const Range& range) { return fmt::format("{:.6g}:{:.6g}", range.low, range.high); }

/// Two numbers that stand for a range; true where they were changed and let go, and hold something.
bool edit_range(const char* label, RangeEdit& edit, const Range& now) {
  if (!edit.active) edit.ends = {now.low, now.high};
  ImGui::InputScalarN(label, ImGuiDataType_Double, edit.ends.data(), 2, nullptr, nullptr, "%.5g");
  edit.active = ImGui::IsItemActive();
  const auto [low, high] = edit.ends;
  return ImGui::IsItemDeactivatedAfterEdit() && std::isfinite(low) && std::isfinite(high) && low < high;
}

Range range_of(const RangeEdit& edit) { return {edit.ends[0], edit.ends[1]}; }

}  // namespace

std::vector<std::string> FlowScene::choices(const std::string& knob) const {
  std::vector<std::string> all;
  if (knob == "vectors") {
    all = offer_.vectors;
    all.insert(all.begin(), "");  // the likeliest
    for (const std::string& field : analytic_vector_names()) all.push_back(field);
  } else if (knob == "color") {
    all = offer_.arrays;
    all.insert(all.begin(), {"speed", "none"});
  }
  return all;
}

void FlowScene::data_panel(Session&) {
  if (!tree_ || corners_.empty()) return;
  Vec3d low = corners_.front(), high = low;
  for (const Vec3d& p : corners_) low = min(low, p), high = max(high, p);
  const Vec3d size = high - low;
  ImGui::Separator();
  text(fmt::format("{} triangles, {} points", grouped((long long)tree_->triangles().size()),
                   grouped((long long)tree_->points().size())));
  text(fmt::format("{:.4g} x {:.4g} x {:.4g} in the data's unit", size.x, size.y, size.z));
  if (data_.time.high > data_.time.low) text(fmt::format("time {:.4g} to {:.4g}", data_.time.low, data_.time.high));
}

void FlowScene::result_panel(Session& session) {
  if (data_.array.empty()) return text("nothing read yet");
  ImGui::PushID("flow");                            // the rest of the panel has a "play", too
  ImGui::PushItemWidth(-9 * ImGui::GetFontSize());  // room for a label and a button
  show_time(session);
  show_range(session);
  ImGui::PopItemWidth();
  ImGui::PopID();
  show_vectors();
  if (shown_) show_embedding();
}

void FlowScene::show_time(Session& session) {
  Settings& settings = session.settings;
  ImGui::Checkbox("play", &settings.look.play);
  ImGui::SameLine();
  text(fmt::format("time {:.4g}   step {}", time_, steps_));
  if (!(data_.time.high > data_.time.low)) return text("steady: one time only");
  const double period = std::max(span_.end - span_.first, 1e-300);
  if (!sliding_) slider_ = float(std::clamp((time_ - span_.first) / period, 0.0, 1.0));
  ImGui::SliderFloat("begin at", &slider_, 0, 1, "%.3f");
  sliding_ = ImGui::IsItemActive();
  if (ImGui::IsItemDeactivatedAfterEdit()) settings.begin_at = std::clamp(double(slider_), 0.0, 1.0);
  if (edit_range("time", time_edit_, {span_.first, span_.end})) settings.time = words_of(range_of(time_edit_));
  ImGui::SameLine();
  if (ImGui::Button("all")) settings.time.clear();
}

void FlowScene::show_range(Session& session) {
  if (data_.color == "none") return;
  std::string& words = session.settings.color_range;
  if (edit_range("colours", colours_edit_, range_)) words = words_of(range_of(colours_edit_));
  ImGui::SameLine();
  bool locked = !words.empty();
  if (ImGui::Checkbox("lock", &locked)) words = locked ? words_of(range_) : "";
}

void FlowScene::show_vectors() const {
  const VectorStatistics& s = data_.statistics;
  ImGui::Separator();
  text(fmt::format("{} ({})", data_.array, data_.reason));
  text(fmt::format("speed: most {:.4g}, 98% below {:.4g}", s.max_speed, s.percentile_98));
  text(fmt::format("normal to the surface {:.1f}%   zero {:.1f}%", 100 * s.normal_share, 100 * s.zero_share));
}

void FlowScene::show_embedding() const {
  const EmbeddingInfo& e = shown_->info;
  ImGui::Separator();
  text(fmt::format("{} of {} x {} x {}", e.kind, e.dimensions.x, e.dimensions.y, e.dimensions.z));
  text(fmt::format("{} cells, {} on the surface", grouped((long long)e.cells), grouped((long long)e.surface_cells)));
  text(fmt::format("{:.1f} bytes a cell, {:.2f}% sparse", double(e.bytes) / double(std::max<std::uint64_t>(1, e.cells)),
                   100 * (1 - double(e.bytes) / std::max(1.0, double(e.dense_bytes)))));
  if (step_seconds_.empty()) return;
  const float most = *std::max_element(step_seconds_.begin(), step_seconds_.end());
  text(fmt::format("{:.3f} s the last step", step_seconds_.back()));
  ImGui::PlotLines("##steps", step_seconds_.data(), int(step_seconds_.size()), 0, nullptr, 0, 1.1f * most,
                   ImVec2(ImGui::GetContentRegionAvail().x, 48));
}

}  // namespace nacre
