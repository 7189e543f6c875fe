// Nacre: the colour legend in the picture, changed by the mouse.
#include "app/viewer/panel/legend_mouse.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "engine/picture/legend.hpp"

namespace nacre {
namespace {

constexpr const char* knobs_of_colours[] = {"colormap",        "color_range", "color_scale",
                                            "color_symmetric", "color_below", "color_above"};

/// Where the bar of the legend and its numbers are.
FreeArea legend_area(const FreeArea& area) {
  const KeptFree room = legend_room(area.width, area.height);
  const auto at = [](double share, int size) { return int(std::lround(share * size)); };
  return {area.x + at(room.left, area.width), area.y + at(room.top, area.height), at(1 - room.left, area.width),
          at(room.bottom - room.top, area.height)};
}

}  // namespace

LegendRange pulled_range(const LegendRange& range, double grabbed, double pulled) {
  const bool log = range.log && range.low > 0;
  const auto axis = [&](double value) { return log ? std::log(value) : value; };
  const auto value = [&](double on_axis) { return log ? std::exp(on_axis) : on_axis; };
  double low = axis(range.low), high = axis(range.high);
  // The colours go with the hand: what lay under it has the colour that it had.
  const double by = pulled * (high - low), least = 0.02 * (high - low);
  if (grabbed < 2.0 / 3) high -= by;
  if (grabbed > 1.0 / 3) low -= by;
  if (high - low < least) (grabbed < 0.5 ? high : low) = grabbed < 0.5 ? low + least : high - least;
  return {value(low), value(high), range.log};
}

void LegendMouse::drag(Settings& settings, const FreeArea& bar) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseDelta.y == 0) return;
  pulled_ -= double(io.MouseDelta.y) / std::max(1, bar.height);
  const LegendRange now = pulled_range(before_, double(grabbed_), pulled_);
  settings.color_symmetric = false;
  settings.color_range = fmt::format("{:.4g}:{:.4g}", now.low, now.high);
}

void LegendMouse::draw(Settings& settings, const LegendRange& range, const FreeArea& area) {
  const FreeArea bar = legend_area(area);
  hovered_ = false;
  if (bar.width <= 0 || bar.height <= 0) return;
  ImGui::SetNextWindowPos(ImVec2(float(bar.x), float(bar.y)));
  ImGui::SetNextWindowSize(ImVec2(float(bar.width), float(bar.height)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  const bool drawn = ImGui::Begin("legend", nullptr, bare_window | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  if (drawn) {
    ImGui::InvisibleButton("bar", ImVec2(float(bar.width), float(bar.height)));
    const bool hovered = hovered_ = ImGui::IsItemHovered();
    if (ImGui::IsItemActivated()) {
      before_ = range;
      grabbed_ = (ImGui::GetIO().MousePos.y - float(bar.y)) / float(bar.height);
      pulled_ = 0;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(0)) ImGui::OpenPopup("colours");
    if (hovered && ImGui::IsMouseClicked(1)) settings.color_range.clear(), settings.color_symmetric = false;
    if (ImGui::IsItemActive()) drag(settings, bar);
    if (hovered && !ImGui::IsItemActive())
      ImGui::SetTooltip("drag an end, or the middle: range\nright click: range of the data\ndouble click: colours");
    const float wide = 24 * ImGui::GetFontSize();
    ImGui::SetNextWindowSizeConstraints(ImVec2(wide, 0), ImVec2(wide, 2 * wide));
    if (ImGui::BeginPopup("colours")) {
      for (const char* name : knobs_of_colours) knob_widget(settings, name);
      ImGui::EndPopup();
    }
  }
  ImGui::End();
}

}  // namespace nacre
