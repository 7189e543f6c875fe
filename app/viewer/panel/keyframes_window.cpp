// Nacre: the window of the keyframes: menus, buttons, and what its edits do. Its list is in keyframes_rows.cpp.
#include "app/viewer/panel/keyframes_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/panel/icon_button.hpp"
#include "app/viewer/panel/imgui_text.hpp"
#include "engine/scene/session/thin_cameras.hpp"
#include "engine/scene/session/window_knobs.hpp"

namespace nacre {
namespace {

/// In the same line as the last one, if there is room.
bool button(const char* name, bool possible, const char* help) {
  const float wide = ImGui::CalcTextSize(name).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (ImGui::GetContentRegionAvail().x < wide) ImGui::NewLine();
  ImGui::BeginDisabled(!possible);
  const bool pressed = ImGui::Button(name);
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", help);
  ImGui::SameLine();
  return pressed;
}

}  // namespace

void KeyframesWindow::edit(Session recording, const std::string& file, Session& session) {
  list_.open(std::move(recording), !file.empty());
  file_ = file;
  selected_.reset();
  told_.clear();
  open_ = true;
  go_to(0, session);
}

void KeyframesWindow::note_saved(const std::string& file) {
  list_.note_saved();
  file_ = file;
}

void KeyframesWindow::undo() {
  list_.undo();
  selected_.reset();
}

void KeyframesWindow::redo() {
  list_.redo();
  selected_.reset();
}

/// The session becomes what the list says; the window stays as it is.
void KeyframesWindow::go_to(double time, Session& session) {
  playhead_ = time;
  went_ = true;
  if (!list_.begun()) return;
  const Session state = list_.state_at(time);
  const Settings window = session.settings;
  static_cast<SessionInput&>(session) = state;
  session.settings = state.settings;
  copy_window_knobs(window, session.settings);
  session.camera = state.camera;
}

/// To where its camera has arrived.
void KeyframesWindow::go_to_selected(Session& session) {
  if (selected_) go_to(has_event() ? event().time + event().over : 0, session);
}

void KeyframesWindow::add(double time, Session& session) {
  told_.clear();
  const std::optional<int> row = list_.add(time, session);
  if (!row) {
    told_ = "nothing differs from the list: change the view or a knob";
    return;
  }
  selected_ = row;
  scrolls_ = frames_to_settle;
  playhead_ = *row == Keyframes::beginning ? 0 : time;
}

void KeyframesWindow::update(const Session& session) {
  told_.clear();
  if (list_.update(*selected_, session)) return;
  const bool opens = has_event() && event().input && *event().input != static_cast<const SessionInput&>(session);
  told_ = opens ? "it opens another input: go to it first" : "nothing differs: it stays as it is";
}

void KeyframesWindow::remove_selected() {
  list_.remove(*selected_);
  selected_ = std::min(*selected_, int(list_.events().size()) - 1);
}

void KeyframesWindow::menus(Session& session, const Facts& facts, Wish& wish) {
  if (!ImGui::BeginMenuBar()) return;
  const bool something = !list_.events().empty();
  if (ImGui::BeginMenu("List")) {
    if (ImGui::MenuItem("New")) {
      list_.begin(session);
      file_.clear();
      selected_ = Keyframes::beginning;
      playhead_ = 0;
    }
    if (ImGui::MenuItem("Open ...")) wish.open = true;
    if (ImGui::MenuItem("End the recording and edit it", nullptr, false, facts.recording)) wish.take_recording = true;
    ImGui::Separator();
    if (ImGui::MenuItem("Save ...", "ctrl s", false, can_save())) wish.save = true;
    if (ImGui::MenuItem("Video ...", nullptr, false, something)) wish.film = true;
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Edit")) {
    if (ImGui::MenuItem("Undo", "ctrl z", false, list_.can_undo())) undo();
    if (ImGui::MenuItem("Redo", "ctrl y", false, list_.can_redo())) redo();
    ImGui::Separator();
    if (ImGui::MenuItem("Duplicate", nullptr, false, has_event())) selected_ = list_.duplicate(*selected_);
    if (ImGui::MenuItem("Delete", "delete", false, has_event())) remove_selected();
    if (ImGui::MenuItem("Add a screenshot ...", nullptr, false, list_.begun())) wish.screenshot = true;
    if (ImGui::MenuItem("Thin out cameras ...", nullptr, false, something)) asks_thin_ = true;
    ImGui::EndMenu();
  }
  ImGui::EndMenuBar();
}

void KeyframesWindow::buttons(Session& session) {
  const bool can_add = session.camera.has_value();
  if (button("Add here", can_add, "the list becomes what you see, at the time of the red line"))
    add(list_.begun() ? playhead_ : 0, session);
  if (button("Add after", can_add, "the same, 2 s after the last keyframe"))
    add(list_.begun() ? list_.last_end() + Keyframes::spacing : 0, session);
  if (button("Update", selected_.has_value(), "the selected keyframe becomes what you see")) update(session);
  if (button("Go to", selected_.has_value(), "see the selected keyframe (or double-click it)")) go_to_selected(session);
  if (button("Delete", has_event(), "remove the selected keyframe (delete)")) remove_selected();
  if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(told_.c_str()).x) ImGui::NewLine();
  ImGui::TextDisabled("%s", told_.c_str());
}

/// Buttons of a player, the time, and the axis.
void KeyframesWindow::player(Session& session, const Facts& facts, Wish& wish) {
  if (facts.time) playhead_ = std::min(*facts.time, std::max(list_.duration(), playhead_));
  const bool narrow = ImGui::GetContentRegionAvail().x < 28 * ImGui::GetFontSize();  // the axis has its own line
  const float top = ImGui::GetCursorPosY(), middle = 0.5f * (KeyframeTrack::height() - ImGui::GetFrameHeight());
  if (!narrow) ImGui::SetCursorPosY(top + middle);
  if (icon_button("begin", begin_icon, "to the beginning")) go_to(0, session);
  if (facts.time) {
    if (icon_button("stop", stop_icon, "stop", true)) wish.stop = true;
  } else if (icon_button("play", play_icon, "play from the red line", !list_.events().empty()) &&
             !list_.events().empty()) {
    wish.play = playhead_ < list_.duration() ? playhead_ : 0;
  }
  ImGui::AlignTextToFramePadding();
  const float before = ImGui::GetCursorPosX();
  text(fmt::format("{:.2f} s", playhead_));
  if (!narrow) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), before + 4.5f * ImGui::GetFontSize()));
    ImGui::SetCursorPosY(top);
  }
  const KeyframeTrack::Wish pulled = track_.draw(list_, selected_, playhead_);
  if (pulled.scrub && (*pulled.scrub != playhead_ || facts.time)) go_to(*pulled.scrub, session);
  if (pulled.select) selected_ = pulled.select;
  if (pulled.go) go_to_selected(session);
  if (pulled.move && has_event()) {
    SessionEvent moved = event();
    moved.time = *pulled.move;
    replace_selected(std::move(moved));
  }
}

void KeyframesWindow::thin_popup() {
  if (std::exchange(asks_thin_, false)) ImGui::OpenPopup("thin out");
  if (!ImGui::BeginPopup("thin out")) return;
  const std::size_t all = list_.events().size();
  text("Cameras that follow each other closely become one that moves smoothly.");
  const double least = 0.1, most = 10;
  ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
  ImGui::SliderScalar("of the picture's height at most", ImGuiDataType_Double, &tolerance_, &least, &most, "%.1f%%",
                      ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  if (thinned_ != std::pair(list_.version(), tolerance_) && !ImGui::IsItemActive()) {
    left_ = thin_cameras(list_.recording(), tolerance_ / 100).size();
    thinned_ = {list_.version(), tolerance_};
  }
  text(fmt::format("{} of {} keyframes are left", left_, all));
  ImGui::BeginDisabled(left_ == all);
  if (ImGui::Button("Thin out")) {
    list_.thin(tolerance_ / 100);
    selected_.reset();
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndDisabled();
  ImGui::EndPopup();
}

KeyframesWindow::Wish KeyframesWindow::draw(Session& session, const FreeArea& area, const Facts& facts) {
  Wish wish;
  focused_ = went_ = false;
  if (!open_ || facts.filming) return wish;
  const float font = ImGui::GetFontSize(), wide = std::min(50 * font, 0.96f * float(area.width));
  ImGui::SetNextWindowSize(ImVec2(wide, std::min(19 * font, 0.6f * float(area.height))), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowPos(ImVec2(float(area.x) + 0.5f * float(area.width), float(area.y + area.height) - 0.5f * font),
                          ImGuiCond_FirstUseEver, ImVec2(0.5f, 1));
  const std::string title =
      fmt::format("Keyframes{}{}{}###keyframes", file_.empty() ? "" : " - ", file_, list_.unsaved() ? " *" : "");
  if (ImGui::Begin(title.c_str(), &open_, ImGuiWindowFlags_MenuBar | ImGuiWindowFlags_NoCollapse)) {
    focused_ = ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows);
    menus(session, facts, wish);
    thin_popup();
    buttons(session);
    player(session, facts, wish);
    rows(session);
    details();
    const bool types = ImGui::GetIO().WantTextInput;
    if (focused_ && !types && has_event() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Delete), false))
      remove_selected();
  }
  ImGui::End();
  if (went_ && facts.time) wish.stop = true;
  return wish;
}

}  // namespace nacre
