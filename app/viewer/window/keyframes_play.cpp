// Nacre: the list of keyframes: opened, saved, played in the window, and filmed.
#include <fmt/format.h>

#include "app/viewer/window/viewer_loop.hpp"
#include "engine/scene/session/window_knobs.hpp"

namespace nacre {

void Viewer::obey_keyframes(const UiRequests& requests) {
  if (requests.stop_keyframes) stop_keyframes();
  if (requests.play_keyframes) attempt([&] { play_keyframes(*requests.play_keyframes); });
  if (requests.film_keyframes) attempt([&] { film_keyframes(*requests.film_keyframes); });
  if (requests.edit_recording)
    attempt(
        [&] { edit_recording(read_session(*requests.edit_recording), requests.edit_recording->filename().string()); });
  if (requests.take_recording && recording_.on())
    attempt([&] {
      note_last_changes();
      edit_recording(recording_.recording(), "");
      recording_.end();
    });
  if (requests.save_keyframes)
    attempt([&] {
      const bool unsaved = unsaved_;  // of what is shown, which need not be in the list
      save(*requests.save_keyframes, session_text(ui_.keyframes().list().recording()));
      unsaved_ = unsaved;
      ui_.keyframes().note_saved(requests.save_keyframes->filename().string());
    });
}

void Viewer::edit_recording(Session recording, const std::string& name) {
  options_.check(recording);
  stop_keyframes();
  ui_.keyframes().edit(std::move(recording), name, session_);
  may_differ_ = redraw_ = true;
}

/// The window keeps its own knobs.
void Viewer::play_keyframes(double from) {
  stop_keyframes();
  player_.emplace(Session());
  scripted_ = false;
  const Session recording = played_in_window(ui_.keyframes().list().recording(), session_.settings);
  options_.check(recording);
  Session begins = recording;
  begins.events.clear();
  begins.duration = 0;
  SessionPlayer player(recording);
  player.advance(from, begins);
  const Settings window = session_.settings;
  if (static_cast<const SessionInput&>(begins) != session_ && opens_beside()) {
    open_beside(std::move(begins), std::move(player), {});
  } else {
    begin_playing(std::move(player));
    session_ = std::move(begins);
  }
  list_play_ = {false, window};
  may_differ_ = redraw_ = true;
}

/// As `nacre view --script --record` makes it, in the size of the window: the recording's own panels are seen, and the
/// scene begins anew.
void Viewer::film_keyframes(const std::filesystem::path& file) {
  stop_keyframes();
  if (film_.on()) throw Error(file.string() + " was not begun", "another video is being made", "end it first");
  const Session& recording = ui_.keyframes().list().recording();
  options_.check(recording);
  film_.begin(file, recording.settings.fps, options_.stop, options_.origin(recording, "video"));
  list_play_ = {true, session_.settings};
  time_.set_fps(recording.settings.fps);
  session_ = ui_.keyframes().list().start();
  turned_ = 0;
  frame_.reset();  // with as many samples as frames that wait have
  begin_playing(SessionPlayer(recording));
  open();
  framing_.hold();
  told_ = session_;
}

void Viewer::stop_keyframes() {
  if (!list_play_) return;
  const ListPlay ended = *std::exchange(list_play_, {});
  player_.emplace(Session());
  scripted_ = false;
  may_differ_ = redraw_ = true;
  if (!ended.films) return;
  copy_window_knobs(ended.window, session_.settings);
  if (!film_.from_menu()) return;  // it could not be written
  attempt([&] {
    film_.finish();
    ui_.show_note(fmt::format("saved {} ({})", film_.file().string(), film_.length()));
  });
  set_lockstep(waits());
}

void Viewer::follow_keyframes(bool shown) {
  if (!list_play_ || opening_) return;
  const bool film_ended = list_play_->films && !film_.from_menu();
  if (film_ended || !player_->plays() || (shown && player_->ended())) stop_keyframes();
}

std::optional<double> Viewer::keyframes_time() const {
  if (!list_play_ || opening_ || !player_->plays()) return {};
  return time_.seconds() - played_since_;
}

}  // namespace nacre
