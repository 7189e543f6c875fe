// Nacre: keyframes on an axis of time.
#include "app/viewer/panel/keyframe_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace nacre {
namespace {

constexpr std::array steps{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1., 2., 5., 10., 20., 60., 120., 300., 600., 3600.};

/// The least of them that is not below `least`.
double step_from(double least) {
  const auto found = std::lower_bound(steps.begin(), steps.end(), least);
  return found == steps.end() ? least : *found;
}

double rounded(double time, double step) { return std::round(std::round(time / step) * step * 1e6) / 1e6; }

const ImVec4 playhead_colour(0.95f, 0.4f, 0.3f, 1);

}  // namespace

float KeyframeTrack::height() { return 3.2f * ImGui::GetFontSize(); }

KeyframeTrack::Axis KeyframeTrack::place(const Keyframes& list, double playhead) {
  if (!pulled_ && !scrubs_) end_ = std::max({1.2 * list.duration(), 1.05 * playhead, 4.0});
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float row = ImGui::GetFontSize(), margin = 0.8f * row;
  return {low, high, row, low.x + margin, std::max(1.0f, high.x - low.x - 2 * margin), end_};
}

void KeyframeTrack::ruler(const Axis& axis) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(axis.low, axis.high, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const double step = step_from(axis.seconds_per_pixel() * 3.5 * double(axis.row));
  for (int k = 0; k * step <= axis.end; ++k) {
    const float x = axis.x_of(k * step);
    const std::string label = fmt::format("{:.6g}{}", rounded(k * step, 0.01), k == 0 ? " s" : "");
    list.AddLine(ImVec2(x, axis.low.y), ImVec2(x, axis.low.y + 0.9f * axis.row), ink);
    if (x + 2 * axis.row < axis.high.x) list.AddText(ImVec2(x + 0.2f * axis.row, axis.low.y), ink, label.c_str());
  }
}

void KeyframeTrack::mark(const Axis& axis, const Mark& mark, bool selected) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = ImGui::GetColorU32(selected ? ImGuiCol_CheckMark : ImGuiCol_Text);
  const float r = 0.34f * axis.row, y = mark.camera ? axis.camera_lane() : axis.knob_lane(), x = axis.x_of(mark.end);
  if (!mark.camera) return list.AddCircleFilled(ImVec2(x, y), 0.8f * r, ink, 16);
  if (mark.end > mark.begin)
    list.AddRectFilled(ImVec2(axis.x_of(mark.begin), y - 0.5f * r), ImVec2(x, y + 0.5f * r),
                       ImGui::GetColorU32(selected ? ImGuiCol_CheckMark : ImGuiCol_Text, 0.35f));
  list.AddQuadFilled(ImVec2(x - r, y), ImVec2(x, y - r), ImVec2(x + r, y), ImVec2(x, y + r), ink);
}

void KeyframeTrack::marks(const Axis& axis, const Keyframes& list, std::optional<int> selected) const {
  mark(axis, {Keyframes::beginning, true, 0, 0}, selected == Keyframes::beginning);
  for (const bool chosen : {false, true})  // above the others
    for (int k = 0; k < int(list.events().size()); ++k) {
      if ((selected == k) != chosen) continue;
      const SessionEvent& event = list.events()[std::size_t(k)];
      const double time = pulled_ == k ? std::max(0.0, event.time + by_) : event.time;
      if (event.camera) mark(axis, {k, true, time, time + event.over}, chosen);
      if (!event.camera || !event.knobs.empty() || event.input || event.screenshot)
        mark(axis, {k, false, time, time}, chosen);
    }
}

/// The row whose mark is next to the mouse; a camera that moves can also be held on its way.
std::optional<int> KeyframeTrack::row_under(const Axis& axis, const Keyframes& list) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool camera = mouse.y < 0.5f * (axis.camera_lane() + axis.knob_lane());
  if (mouse.y < axis.low.y + axis.row) return {};  // the ruler
  std::optional<int> row;
  float nearest = 0.6f * axis.row;
  const auto offer = [&](int k, float away) {
    if (away < nearest) row = k, nearest = away;
  };
  if (camera) offer(Keyframes::beginning, std::abs(mouse.x - axis.x_of(0)));
  for (int k = 0; k < int(list.events().size()); ++k) {
    const SessionEvent& event = list.events()[std::size_t(k)];
    if (camera != event.camera.has_value() && (camera || (event.knobs.empty() && !event.input && !event.screenshot)))
      continue;
    const double end = camera ? event.time + event.over : event.time;
    offer(k, std::abs(mouse.x - axis.x_of(end)));
    const bool on_its_way = mouse.x > axis.x_of(event.time) && mouse.x < axis.x_of(end);
    if (on_its_way) offer(k, 0.59f * axis.row);
  }
  return row;
}

/// A round time, or that of a keyframe close by.
double KeyframeTrack::time_under(const Axis& axis, const Keyframes& list) {
  const double per_pixel = axis.seconds_per_pixel();
  const double exact = std::clamp(double(ImGui::GetIO().MousePos.x - axis.left) * per_pixel, 0.0, axis.end);
  double time = rounded(exact, step_from(per_pixel)), nearest = 4 * per_pixel;
  const auto offer = [&](double candidate) {
    if (std::abs(candidate - exact) < nearest) time = candidate, nearest = std::abs(candidate - exact);
  };
  for (const SessionEvent& event : list.events()) offer(event.time), offer(event.time + event.over);
  return time;
}

KeyframeTrack::Wish KeyframeTrack::use(const Axis& axis, const Keyframes& list, std::optional<int> selected) {
  Wish wish;
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActivated()) {
    pulled_ = row_under(axis, list);
    scrubs_ = !pulled_;
    by_ = 0;
    if (pulled_) wish.select = pulled_;
    wish.go = pulled_ && ImGui::IsMouseDoubleClicked(0);
  }
  if (ImGui::IsItemActive() && scrubs_) wish.scrub = time_under(axis, list);
  if (ImGui::IsItemActive() && pulled_ && *pulled_ >= 0 && ImGui::IsMouseDragging(0)) {
    const double time = list.events()[std::size_t(*pulled_)].time, per_pixel = axis.seconds_per_pixel();
    const double wanted = time + double(io.MousePos.x - io.MouseClickedPos[0].x) * per_pixel;
    by_ = std::max(0.0, rounded(wanted, step_from(per_pixel))) - time;
  }
  if (ImGui::IsItemDeactivated()) {
    if (pulled_ && pulled_ == selected && by_ != 0) wish.move = list.events()[std::size_t(*pulled_)].time + by_;
    pulled_.reset();
    scrubs_ = false;
    by_ = 0;
  }
  return wish;
}

KeyframeTrack::Wish KeyframeTrack::draw(const Keyframes& list, std::optional<int> selected, double playhead) {
  ImGui::InvisibleButton("track", ImVec2(std::max(1.0f, ImGui::GetContentRegionAvail().x), height()));
  const Axis axis = place(list, playhead);
  if (pulled_ && *pulled_ >= int(list.events().size())) pulled_.reset();
  const Wish wish = use(axis, list, selected);
  ruler(axis);
  if (list.begun()) marks(axis, list, selected);
  const float x = axis.x_of(std::min(playhead, axis.end)), r = 0.35f * axis.row;
  ImDrawList& drawn = *ImGui::GetWindowDrawList();
  const ImU32 red = ImGui::GetColorU32(playhead_colour);
  drawn.AddLine(ImVec2(x, axis.low.y), ImVec2(x, axis.high.y), red, std::max(1.0f, 0.1f * axis.row));
  drawn.AddTriangleFilled(ImVec2(x - r, axis.low.y), ImVec2(x + r, axis.low.y), ImVec2(x, axis.low.y + 1.3f * r), red);
  if (pulled_ && *pulled_ >= 0)
    ImGui::SetTooltip("%.2f s", list.events()[std::size_t(*pulled_)].time + by_);
  else if (scrubs_ || ImGui::IsItemHovered())
    ImGui::SetTooltip("%.2f s", time_under(axis, list));
  return wish;
}

}  // namespace nacre
