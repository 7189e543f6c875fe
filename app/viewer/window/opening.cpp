// Nacre: another input is read beside the scene that is shown, and replaces it when there is something to see.
#include <fmt/format.h>

#include "app/viewer/window/viewer_loop.hpp"

namespace nacre {

/// Frames that wait for the computation, and scripts, open at once: what they show must not depend on how fast it is
/// read.
bool Viewer::opens_beside() const {
  return window_ && !waits() && (!scripted_ || player_->ended()) && !scene().corners().empty();
}

void Viewer::open_beside(Session wanted, std::optional<SessionPlayer> player, const std::filesystem::path& file,
                         OpenScene again) {
  opening_.reset();
  Opening opening{{}, std::move(wanted), session_, std::move(player), file, {}};
  opening.open = again.scene ? std::move(again) : open_scene(opening.session, scene_options());
  opening_.emplace(std::move(opening));
  redraw_ = true;
}

/// A new input of the session is opened beside the scene before anything else sees it. False: there is none, or it
/// is to be opened at once.
bool Viewer::divert_input() {
  if (static_cast<const SessionInput&>(session_) == told_ || !opens_beside()) return false;
  Session wanted = std::exchange(session_, told_);
  attempt([&] { open_beside(std::move(wanted), {}, {}); });
  return true;
}

/// True where the session is that of another input from now on.
bool Viewer::take_opened() {
  if (!opening_) return false;
  Scene& next = *opening_->open.scene;
  next.advance(now());
  const std::string failure = next.lost_device().empty() ? next.failure() : next.lost_device();
  if (!failure.empty()) {
    const std::string what = input_name(opening_->session);
    opening_.reset();
    show_error(fmt::format("{} was not opened: {}", what, failure));
    return false;
  }
  if (next.corners().empty()) return false;  // nothing to see yet
  Opening opened = std::move(*opening_);
  opening_.reset();
  keep_thumbnail();
  if (scene().lost_device().empty()) left_.keep(std::move(open_), told_);
  leave_scene();
  open_ = std::move(opened.open);
  const Session asked = opened.session;
  // What was changed meanwhile stays, such as panels and theme.
  if (const std::optional<SessionEvent> since = session_change(opened.before, session_)) {
    SessionEvent knobs_alone;
    knobs_alone.knobs = since->knobs;
    apply_event(knobs_alone, opened.session);
  }
  session_ = std::move(opened.session);
  const ChangedKnobs changed = changed_knobs(asked, session_);
  if (!changed.empty()) scene().set_settings(session_.settings, changed);
  if (opened.player) begin_playing(std::move(*opened.player));
  if (!opened.file.empty()) recent_.add(opened.file);
  note_recent();
  if (opened.history && changed.empty()) undo_ = std::move(*opened.history);
  redraw_ = true;
  return true;
}

void Viewer::give_opening_up() {
  if (!opening_) return;
  ui_.show_note(input_name(opening_->session) + " was not opened");
  opening_.reset();
  redraw_ = true;
}

/// The scene that showed this input before, as it is wanted now; none: it is not kept.
OpenScene Viewer::left_scene(const Session& wanted) {
  std::optional<LeftScenes::Left> left = left_.take(wanted);
  if (!left) return {};
  const ChangedKnobs changed = changed_knobs(left->session, wanted);
  if (!changed.empty()) left->open.scene->set_settings(wanted.settings, changed);
  left->open.scene->resume();
  return std::move(left->open);
}

/// Undo and redo of an input: made when that is there, and not at all where it cannot be opened.
void Viewer::move_in_history(bool back) {
  Session wanted = session_;
  Undo moved = undo_;
  back ? moved.undo(wanted) : moved.redo(wanted);
  if (static_cast<const SessionInput&>(wanted) == session_ || !opens_beside()) {
    undo_ = std::move(moved);
    session_ = std::move(wanted);
    return;
  }
  attempt([&] {
    OpenScene again = left_scene(wanted);
    open_beside(std::move(wanted), {}, {}, std::move(again));
    opening_->history = std::move(moved);
  });
}

std::string Viewer::input_name(const SessionInput& input) {
  if (!input.sample.empty()) return "the sample " + input.sample;
  return input.inputs.empty() ? "the input" : input.inputs.front().filename().string();
}

}  // namespace nacre
