// Nacre: the bar under the picture.
#include "app/viewer/panel/transport_bar.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/viewer/flow/flow_results.hpp"
#include "app/viewer/panel/icon_button.hpp"
#include "app/viewer/panel/imgui_text.hpp"

namespace nacre {
namespace {

std::string position_text(const Transport& t, int position) {
  if (t.kind == Transport::Kind::iterations) return fmt::format("iteration {}", position);
  if (t.per_step == 0) return fmt::format("step {}", position);
  return "t = " + time_text(t.time_of(position));
}

}  // namespace

int TransportBar::height() { return int(std::ceil(1.7f * ImGui::GetFrameHeight())); }

void TransportBar::go_to(Session& session, const Transport& t, int position) {
  if (t.kind == Transport::Kind::time)
    session.settings.begin_at = begin_at_of(position, std::max(1, session.settings.flow.steps));
  else
    session.settings.view.iteration = position;
}

void TransportBar::pause(Session& session, const Transport& t) {
  session.settings.view.play = false;
  if (t.shown >= t.first) go_to(session, t, t.shown);
}

void TransportBar::toggle_play(Session& session, const Transport& t) {
  if (session.settings.view.play && !t.ended) return pause(session, t);
  if (t.kind == Transport::Kind::time && t.ended) return rewind(session, t);
  session.settings.view.play = true;
  session.settings.view.iteration = 0;
}

/// What is written now may be what the knob holds already, of a time that has gone by since: it is paused first.
void TransportBar::rewind(Session& session, const Transport& t) {
  pause(session, t);
  next_ = t.first;
}

void TransportBar::step(Session& session, const Transport& t, int by) {
  if (t.kind == Transport::Kind::none) return;
  if (session.settings.view.play) return pause(session, t);  // the first press stands still
  const bool around = t.kind == Transport::Kind::time && t.first == 0;
  const int count = t.last - t.first + 1;
  int to = t.shown + by;
  if (around)
    to = (to % count + count) % count;
  else if (t.kind == Transport::Kind::time || by < 0 || t.ended)
    to = std::clamp(to, t.first, t.last);
  go_to(session, t, to);  // beyond the last iteration: one more is made
}

void TransportBar::buttons(Session& session, const Transport& t) {
  ViewSettings& view = session.settings.view;
  const bool mesh = t.kind == Transport::Kind::iterations, plays = view.play && !t.ended;
  if (icon_button("begin", begin_icon, mesh ? "to the first iteration" : "to the first time")) {
    if (mesh)
      pause(session, t), go_to(session, t, t.first);
    else
      rewind(session, t);
  }
  if (icon_button("back", back_icon, "one step back ( , )")) step(session, t, -1);
  if (icon_button("play", plays ? pause_icon : play_icon, plays ? "pause (space)" : "play (space)", !plays))
    toggle_play(session, t);
  if (icon_button("forth", forth_icon, "one step forward ( . )")) step(session, t, 1);
  if (mesh) return;
  if (icon_button("loop", loop_icon, view.loop ? "begins again after the last time" : "stops at the last time",
                  view.loop))
    view.loop = !view.loop;
}

/// Positions from left to right: those that can be shown at once, times of the data, and what is seen.
void TransportBar::track(Session& session, const Transport& t) {
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  if (size.x < 1) return;
  ImGui::InvisibleButton("track", size);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float r = 0.3f * size.y, left = low.x + r, wide = std::max(1.0f, high.x - low.x - 2 * r);
  const float y = 0.5f * (low.y + high.y);
  const int count = std::max(1, t.last - t.first);
  const auto x_of = [&](double position) { return left + wide * float((position - t.first) / count); };
  const auto under = [&] {
    const double share = std::clamp(double(ImGui::GetIO().MousePos.x - left) / wide, 0.0, 1.0);
    return t.first + int(std::lround(share * (t.last - t.first)));
  };
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(ImVec2(left, y - 0.1f * size.y), ImVec2(left + wide, y + 0.1f * size.y),
                     ImGui::GetColorU32(ImGuiCol_FrameBg), 2);
  const float half = 0.5f * wide / float(count);
  for (int p = t.first; p <= t.last; ++p)
    if (t.is_warm(p))
      list.AddRectFilled(ImVec2(std::max(left, x_of(p) - half), y - 0.1f * size.y),
                         ImVec2(std::min(left + wide, x_of(p) + half), y + 0.1f * size.y),
                         ImGui::GetColorU32(ImGuiCol_SliderGrab));
  if (t.per_step > 0 && t.data_times.size() < std::size_t(0.2f * wide))
    for (const double time : t.data_times) {
      const float x = x_of((time - t.start) / t.per_step);
      if (x >= left - 1 && x <= left + wide + 1)
        list.AddLine(ImVec2(x, y + 0.22f * size.y), ImVec2(x, y + 0.4f * size.y), ImGui::GetColorU32(ImGuiCol_Text));
    }
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  if (t.shown >= t.first) {
    const ImVec2 at(x_of(std::min(t.shown, t.last)), y);
    if (t.warming)
      list.AddCircle(at, r, ink, 20, 2);
    else
      list.AddCircleFilled(at, r, ink, 20);
  }
  const bool held = ImGui::IsItemActive() && t.moves();
  if (held && !scrubs_) {
    played_ = session.settings.view.play && !t.ended;
    if (played_) pause(session, t);  // and from the next frame on it follows the mouse
  } else if (held && under() != t.shown) {
    go_to(session, t, under());
  } else if (!held && scrubs_ && played_) {
    session.settings.view.play = true;
    session.settings.view.iteration = 0;
  }
  scrubs_ = held;
  if (!ImGui::IsItemHovered() && !held) return;
  const char* what = t.is_warm(under()) ? "" : t.kind == Transport::Kind::time ? "\n(the texture begins there)" : "";
  ImGui::SetTooltip("%s%s", position_text(t, under()).c_str(), what);
}

void TransportBar::labels(const Session& session, const Transport& t, bool narrow) {
  ImGui::AlignTextToFramePadding();
  if (t.shown >= t.first && !narrow) {
    std::string line = position_text(t, t.shown);
    if (t.kind == Transport::Kind::time && t.per_step > 0)
      line += fmt::format(" of {} to {}", time_text(t.start), time_text(t.time_of(t.first == 0 ? t.last + 1 : t.last)));
    else if (t.moves())
      line += fmt::format(" of {}", t.last);
    text(line);
    ImGui::SameLine();
  }
  const char* state = t.warming                                                   ? "warming up"
                      : t.ended && t.kind == Transport::Kind::time                ? "at the end"
                      : t.ended                                                   ? "done"
                      : !session.settings.view.play                               ? "paused"
                      : t.kind == Transport::Kind::iterations && t.shown < t.last ? "looking back"
                                                                                  : "";
  if (*state) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
    ImGui::TextUnformatted(state);
    ImGui::PopStyleColor();
    ImGui::SameLine();
  }
}

void TransportBar::speed(Session& session) {
  double& speed = session.settings.view.play_speed;
  ImGui::SetNextItemWidth(4.5f * ImGui::GetFontSize());
  if (ImGui::BeginCombo("##speed", fmt::format("{:.4g}x", speed).c_str())) {
    for (const double each : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0})
      if (ImGui::Selectable(fmt::format("{:.4g}x", each).c_str(), each == speed)) speed = each;
    ImGui::EndCombo();
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("speed; 1x: %d steps a second", session.settings.fps);
  ImGui::SameLine();
}

void TransportBar::draw(Session& session, const Transport& t, const FreeArea& area) {
  if (next_) {
    go_to(session, t, *std::exchange(next_, {}));
    session.settings.view.play = true;
  }
  ImGui::SetNextWindowPos(ImVec2(float(area.x), float(area.y)));
  ImGui::SetNextWindowSize(ImVec2(float(area.width), float(area.height)));
  const auto fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoScrollWithMouse;
  const ImVec2 padding(ImGui::GetStyle().WindowPadding.x, 0.35f * ImGui::GetFrameHeight());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  if (ImGui::Begin("time", nullptr, fixed) && t.kind != Transport::Kind::none) {
    buttons(session, t);
    const bool narrow = float(area.width) < 36 * ImGui::GetFontSize();  // the track comes first
    if (t.kind == Transport::Kind::time && !narrow) speed(session);
    const ImVec2 here = ImGui::GetCursorPos();
    labels(session, t, narrow);
    const float end = ImGui::GetCursorPosX();
    const float wide = (t.kind == Transport::Kind::time ? 22 : 18) * ImGui::GetFontSize();  // the track stays in place
    ImGui::SetCursorPos(
        ImVec2(std::max(end, narrow ? end : std::min(here.x + wide, 0.5f * float(area.width))), here.y));
    track(session, t);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace nacre
