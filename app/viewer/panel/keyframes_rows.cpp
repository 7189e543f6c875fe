// Nacre: the list of the keyframes, and what the selected one changes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/keyframes_window.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

std::string opened_text(const SessionInput& input) {
  if (!input.sample.empty()) return "open the sample " + input.sample;
  std::string line = "open";
  std::error_code ignored;
  for (const std::filesystem::path& file : input.inputs)
    line += " " + file.filename().string() + (std::filesystem::exists(file, ignored) ? "" : " (not found)");
  return line;
}

/// "camera, there at 2.00 s, edges = true"
std::string change_text(const SessionEvent& event) {
  std::string line;
  const auto add = [&](const std::string& part) { line += (line.empty() ? "" : ", ") + part; };
  if (event.input) add(opened_text(*event.input));
  if (event.camera) add(event.over > 0 ? fmt::format("camera, there at {:.2f} s", event.time + event.over) : "camera");
  for (const auto& [name, value] : event.knobs) add(fmt::format("{} = {}", name, value.empty() ? "(empty)" : value));
  if (event.screenshot) add("screenshot " + event.screenshot->file.filename().string());
  return line;
}

/// Below the list: where it says all, none.
std::size_t detail_lines(const SessionEvent& event) {
  return event.knobs.empty() ? 0 : event.knobs.size() + (event.camera ? 1 : 0);
}

/// A button before what it leaves out.
bool leave_out(const std::string& name) {
  ImGui::PushID(name.c_str());
  const bool pressed = ImGui::Button("x");
  ImGui::PopID();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("leave %s as it is", name.c_str());
  ImGui::SameLine();
  return pressed;
}

constexpr const char* hint =
    "Choose a view and press \"Add here\": that is the beginning. Then change the view or knobs, and press "
    "\"Add after\": the camera gets there in 2 s. Play shows the result.";

}  // namespace

/// A time to be pulled or typed. True when it is let go with another value.
bool KeyframesWindow::seconds_field(const char* name, double& value) {
  const ImGuiID id = ImGui::GetID(name);
  double shown = held_ == id ? held_value_ : value;
  const double least = 0, most = longest_session;
  ImGui::SetNextItemWidth(-1);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(0, 0, 0, 0));
  ImGui::DragScalar(name, ImGuiDataType_Double, &shown, 0.02f, &least, &most, "%.2f s", ImGuiSliderFlags_AlwaysClamp);
  ImGui::PopStyleColor();
  if (ImGui::IsItemActive()) held_ = id, held_value_ = shown;
  const bool changed = ImGui::IsItemDeactivatedAfterEdit() && shown != value;
  if (ImGui::IsItemDeactivated()) held_ = 0;
  if (changed) value = std::isfinite(shown) ? std::round(shown * 1000) / 1000 : value;
  return changed;
}

/// The whole row is a button, and fields lie over it.
bool KeyframesWindow::select_row(int row, Session& session) {
  const float high = ImGui::GetFrameHeight();
  const auto flags = ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap |
                     ImGuiSelectableFlags_AllowDoubleClick;
  const bool pressed = ImGui::Selectable("##row", selected_ == row, flags, ImVec2(0, high));
  if (pressed) selected_ = row;
  if (selected_ == row && scrolls_ > 0) {
    const float top = ImGui::GetWindowPos().y + high, bottom = ImGui::GetWindowPos().y + ImGui::GetWindowHeight();
    if (ImGui::GetItemRectMin().y < top || ImGui::GetItemRectMax().y > bottom) ImGui::SetScrollHereY();
    --scrolls_;
  }
  if (pressed && ImGui::IsMouseDoubleClicked(0)) go_to_selected(session);
  ImGui::SameLine();
  return pressed;
}

void KeyframesWindow::beginning_row(Session& session) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  select_row(Keyframes::beginning, session);
  ImGui::AlignTextToFramePadding();
  const char* const time = "0.00 s";  // in the middle, as in the fields below it
  const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(time).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, 0.5f * free));
  ImGui::TextUnformatted(time);
  ImGui::TableNextColumn();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  text("the beginning: " + opened_text(list_.recording()));
}

void KeyframesWindow::event_row(int row, Session& session) {
  SessionEvent changed = list_.events()[std::size_t(row)];
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  select_row(row, session);
  bool edited = seconds_field("##time", changed.time);
  if (ImGui::IsItemActivated()) selected_ = row;
  ImGui::TableNextColumn();
  if (changed.camera && !changed.input) {
    edited = seconds_field("##over", changed.over) || edited;
    if (ImGui::IsItemActivated()) selected_ = row;
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("0: the camera jumps");
  }
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  const std::string what = change_text(changed);
  text(what);
  if (ImGui::IsItemHovered() && ImGui::CalcTextSize(what.c_str()).x > ImGui::GetContentRegionAvail().x) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
    text(what);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  if (edited) {
    selected_ = list_.replace(row, std::move(changed));
    scrolls_ = frames_to_settle;
  }
}

void KeyframesWindow::rows(Session& session) {
  if (!list_.begun()) return ImGui::TextWrapped("%s", hint);
  const int events = int(list_.events().size());
  if (selected_ && *selected_ >= events) selected_.reset();
  const float free = ImGui::GetContentRegionAvail().y, line = ImGui::GetFrameHeightWithSpacing();
  const std::size_t lines = has_event() ? detail_lines(event()) : 0;
  below_ = lines == 0 ? 0 : std::min(float(lines) * line + ImGui::GetStyle().ItemSpacing.y, 0.45f * free);
  const auto flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersOuterH;
  const float high = std::max(3 * ImGui::GetFrameHeight(), free - below_);
  if (!ImGui::BeginTable("keyframes", 3, flags, ImVec2(0, high))) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("time", ImGuiTableColumnFlags_WidthFixed, 5.5f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("over", ImGuiTableColumnFlags_WidthFixed, 5.5f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("what changes", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableHeadersRow();
  ImGuiListClipper clipper;
  clipper.Begin(events + 1);
  if (std::exchange(seen_, selected_) != selected_) scrolls_ = frames_to_settle;
  if (scrolls_ > 0 && selected_) clipper.ForceDisplayRangeByIndices(*selected_ + 1, *selected_ + 2);
  const long version = list_.version();
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd && list_.version() == version; ++k) {
      ImGui::PushID(k);
      k == 0 ? beginning_row(session) : event_row(k - 1, session);
      ImGui::PopID();
    }
  ImGui::EndTable();
}

/// What the selected keyframe changes: knobs have their widgets, and each can be left out.
void KeyframesWindow::details() {
  if (!has_event() || below_ == 0) return;
  SessionEvent changed = event();
  if (ImGui::BeginChild("details")) {
    Settings settings;
    for (const auto& [name, value] : changed.knobs) set_knob(settings, name, value);
    for (const auto& [name, value] : event().knobs) {
      if (leave_out(name)) changed.knobs.erase(name);
      knob_widget(settings, name);
    }
    if (event().camera) {
      if (leave_out("the camera")) changed.camera.reset();
      text("camera");
    }
    for (const Knob& knob : knobs(settings))
      if (changed.knobs.contains(knob.name)) changed.knobs[knob.name] = knob.text();
  }
  ImGui::EndChild();
  if (changed.knobs != event().knobs || changed.camera != event().camera) replace_selected(std::move(changed));
}

}  // namespace nacre
