// Nacre: what a volume is, in the tab "data".
#include "app/viewer/panel/volume_facts.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace nacre {
namespace {

void line(const std::string& what) { ImGui::TextWrapped("%s", what.c_str()); }

/// The iso-value as text, if it is one number.
std::optional<double> single_isovalue(const std::string& isovalue) {
  char* end = nullptr;
  const double value = std::strtod(isovalue.c_str(), &end);
  if (isovalue.empty() || *end != '\0' || !std::isfinite(value)) return {};
  return value;
}

/// A mark over the plot that was drawn last, at a share of its width.
void mark(double share) {
  if (share < 0 || share > 1) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float x = low.x + float(share) * (high.x - low.x);
  ImGui::GetWindowDrawList()->AddLine(ImVec2(x, low.y), ImVec2(x, high.y), IM_COL32(235, 90, 60, 255), 2);
}

/// Takes effect when it is let go: each value begins a mesh.
void isovalue_slider(const ValueSpread& spread, std::string& isovalue, double now) {
  static double held = 0;
  static bool active = false;
  if (!active) held = now;
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::PlotHistogram("##values", spread.histogram.data(), int(spread.histogram.size()), 0, nullptr, 0, FLT_MAX,
                       ImVec2(width, 4 * ImGui::GetFontSize()));
  mark((held - spread.low) / (spread.high - spread.low));
  ImGui::SetNextItemWidth(width);
  ImGui::SliderScalar("##isovalue", ImGuiDataType_Double, &held, &spread.low, &spread.high, "iso-value %.4g",
                      ImGuiSliderFlags_AlwaysClamp);
  active = ImGui::IsItemActive();
  if (ImGui::IsItemDeactivatedAfterEdit()) isovalue = fmt::format("{:.4g}", held);
}

}  // namespace

void draw_volume_facts(const ViewedVolume& volume, Session& session) {
  const MeshInput& input = volume.input;
  const Volume& first = volume.volumes->front();
  const Vec3d size = Vec3d(input.dims) * input.spacing;
  ImGui::Separator();
  line(fmt::format("{} x {} x {} voxels of {}", input.dims.x, input.dims.y, input.dims.z,
                   value_type_name(first.values)));
  line(fmt::format("{:.4g} x {:.4g} x {:.4g} each, in the data's unit", input.spacing.x, input.spacing.y,
                   input.spacing.z));
  line(fmt::format("{:.4g} x {:.4g} x {:.4g} in all", size.x, size.y, size.z));
  if (!first.space.empty()) line("x, y, z point to " + first.space);
  if (input.kind != MeshVolume::Kind::scalar) return line(fmt::format("{} materials", input.labels.size() - 1));
  const ValueSpread& spread = volume.spread;
  line(fmt::format("values {:.6g} to {:.6g}; nearly all from {:.4g} to {:.4g}", spread.min, spread.max, spread.low,
                   spread.high));
  std::string& isovalue = session.settings.materials.isovalue;
  if (const std::optional<double> now = single_isovalue(isovalue)) isovalue_slider(spread, isovalue, *now);
}

}  // namespace nacre
