// Nacre: what the user asks of the viewer: to open, save, record, take a picture, quit.
#include <fmt/format.h>

#include <cmath>

#include "app/viewer/window/viewer_loop.hpp"

namespace nacre {

void Viewer::try_to_quit() {
  std::vector<std::string> reasons = reasons_to_stay();
  if (reasons.empty() || ui_.asks_quit())
    quit_ = true;
  else
    ui_.ask_quit(std::move(reasons));
}

std::vector<std::string> Viewer::reasons_to_stay() const {
  std::vector<std::string> reasons;
  const SceneProgress progress = this->progress();
  if (!progress.stage.empty()) reasons.push_back(fmt::format("The computation ({}) has not finished.", progress.stage));
  if (film_.from_menu()) reasons.push_back("A video is being recorded.");
  if (recording_.on() && !recording_.has_file()) reasons.push_back("Your actions are being recorded.");
  if (ui_.keyframes().list().unsaved()) reasons.push_back("The list of keyframes has not been saved.");
  if (unsaved_ && !recording_.has_file())
    reasons.push_back("You have changed parameters and saved neither session nor result.");
  return reasons;
}

void Viewer::leave_scene() {
  if (const std::string lost = saving_.drop(); !lost.empty()) show_error(lost);
  open_.reset();
  painter_->forget();
  event_log_.forget();
  framing_.forget();
}

void Viewer::open() {
  opening_.reset();
  leave_scene();
  note_recent();
  open_ = open_scene(session_, scene_options());
  comparison_.close();
  follow_comparison();
}

void Viewer::follow_comparison() {
  attempt([&] { comparison_.follow(session_, scene(), scene_options()); });
  if (!comparison_.on()) scene().keep_together({});
}

void Viewer::halt() {
  scene().cancel();
  if (comparison_.on()) comparison_.scene().cancel();
}

void Viewer::resume() {
  scene().resume();
  if (comparison_.on()) comparison_.scene().resume();
}

void Viewer::set_lockstep(bool on) {
  scene().set_lockstep(on);
  if (comparison_.on()) comparison_.scene().set_lockstep(on);
}

/// Of what is read, else of the first scene, else of the second.
SceneProgress Viewer::progress() const {
  if (opening_) return {"opening " + input_name(opening_->session), -1};
  const SceneProgress first = scene().progress();
  return first.stage.empty() && comparison_.on() ? comparison_.scene().progress() : first;
}

/// A number of frames is for headless runs to compare with: these do not begin again after the last time.
SceneOptions Viewer::scene_options() const {
  return {spare_ ? options_.open_spare_device : options_.open_device, options_.frames == 0, waits(), !waits(),
          options_.stop};
}

void Viewer::note_recent() {
  for (const auto& file : session_.inputs)
    if (window_) recent_.add(file);
}

void Viewer::keep_thumbnail() {
  if (!window_ || told_.inputs.size() != 1 || !scene().complete() || !scene().lost_device().empty()) return;
  Framebuffer small(Thumbnails::width, Thumbnails::height, 4);
  const View view = scene_view(told_, scene().corners(), turned_, small.width(), small.height());
  small.bind();
  small.clear(background_of(told_.settings));
  scene().draw(view);
  thumbnails_.keep(told_.inputs.front(), small.read());
  thumbnails_.keep_only(recent_.files());
}

std::vector<RecentFile> Viewer::recent_files() {
  std::vector<RecentFile> all;
  for (const std::filesystem::path& file : recent_.files()) all.push_back({file, thumbnails_.texture(file)});
  return all;
}

void Viewer::leave_lost_device() {
  const std::string why =
      scene().lost_device().empty() && comparison_.on() ? comparison_.scene().lost_device() : scene().lost_device();
  if (why.empty() || spare_ || !window_) return;
  spare_ = true;
  show_error(fmt::format("{} stopped working ({}); the processor computes from now on", scene().device().name(), why));
  open();
}

void Viewer::take_picture(const Screenshot& picture) {
  Image image;
  if (picture.panel) {
    image = frame_->read();
  } else {
    Framebuffer large(frame_->width() * picture.scale, frame_->height() * picture.scale, 4);
    draw_scene(large, {0, 0, large.width(), large.height()},
               picture.transparent ? std::array<float, 4>{0, 0, 0, 0} : background_of(session_.settings));
    image = large.read();
  }
  write_png(picture.file, image, options_.origin(shown_session(), "screenshot"));
  result_.pictures.push_back(picture.file);
}

/// Stopped at the time that is seen.
Session Viewer::shown_session() const {
  Session shown = session_;
  if (shown.camera) shown.camera = orbit(*shown.camera, turned_);
  const Transport at = scene().transport();
  if (at.kind != Transport::Kind::time || at.shown < 0) return shown;
  shown.settings.view.play = false;
  shown.settings.begin_at = begin_at_of(at.shown, std::max(1, shown.settings.flow.steps));
  return shown;
}

void Viewer::show_error(const std::string& line) {
  redraw_ = true;
  ui_.show_error(line);
  event_log_.add_error(line);
}

void Viewer::obey(const UiRequests& requests) {
  if (requests.quit) try_to_quit();
  if (requests.undo || requests.redo) move_in_history(requests.undo);
  if (requests.cancel && opening_)
    give_opening_up();
  else if (requests.cancel)
    halt();
  if (requests.resume) resume();
  if (session_.camera && requests.fit) fit_what_is_seen();
  if (session_.camera && !requests.look_from.empty()) framing_.look_from(requests.look_from, session_, scene(), area_);
  if (requests.load_session) attempt([&] { load_session(*requests.load_session); });
  if (!requests.tour.empty())
    attempt([&] {
      Session tour = parse_session(requests.tour);
      tour.settings.view = session_.settings.view;  // the window stays as it is
      tour.settings.background = session_.settings.background;
      play(std::move(tour), {});
    });
  if (requests.save_session) attempt([&] { save(*requests.save_session, session_text(session_)); });
  if (requests.save_result)
    attempt([&] { saving_.begin(scene(), *requests.save_result, options_.origin(session_, "out")); });
  obey_recording(requests);
  obey_keyframes(requests);
}

void Viewer::tell_saved() {
  const std::optional<Saving::Outcome> saved = saving_.poll(scene());
  if (!saved) return;
  redraw_ = true;
  if (saved->failure.empty()) unsaved_ = false;
  if (saved->failure.empty())
    ui_.show_note("saved " + saved->file.string());
  else
    show_error(saved->file.string() + " was not saved: " + saved->failure);
}

void Viewer::obey_recording(const UiRequests& requests) {
  if (requests.record) recording_.begin(session_, session_.settings.fps, time_.seconds());
  if (requests.save_recording && recording_.on())
    attempt([&] {
      note_last_changes();
      save(*requests.save_recording, session_text(recording_.recording()));
      recording_.end();
    });
  if (requests.film)
    attempt([&] {
      film_.begin(*requests.film, session_.settings.fps, options_.stop, options_.origin(shown_session(), "video"));
      time_.set_fps(session_.settings.fps);
      set_lockstep(true);
    });
  if (requests.end_film && film_.from_menu()) {
    attempt([&] {
      film_.finish();
      ui_.show_note(fmt::format("saved {} ({})", film_.file().string(), film_.length()));
    });
    set_lockstep(waits());
  }
}

void Viewer::save(const std::filesystem::path& file, const std::string& text) {
  OutputFile out(file);
  out.write(text);
  out.commit();
  unsaved_ = false;
  ui_.show_note("saved " + file.string());
}

/// `file`: where it comes from; empty: from the program itself.
void Viewer::play(Session loaded, const std::filesystem::path& file) {
  options_.check(loaded);
  stop_keyframes();
  SessionPlayer player(loaded);
  loaded.events.clear();
  loaded.duration = 0;
  if (static_cast<const SessionInput&>(loaded) != session_ && opens_beside())
    return open_beside(std::move(loaded), std::move(player), file);
  begin_playing(std::move(player));
  if (!loaded.camera) framing_.forget();
  session_ = std::move(loaded);
  if (!file.empty()) recent_.add(file);
}

void Viewer::open_dropped() {
  if (dropped_.size() == 1 && may_hold_session(dropped_[0])) {
    const std::vector<std::filesystem::path> file = std::exchange(dropped_, {});
    return attempt([&] { load_session(file[0]); });
  }
  static_cast<SessionInput&>(session_) = {std::exchange(dropped_, {}), "", 0};  // take_changes opens it
  session_.camera.reset();
}

}  // namespace nacre
