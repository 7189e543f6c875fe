// Nacre: the loop of the viewer: frames, from what the scene has to what is on the screen.
#include <fmt/format.h>

#include <cmath>

#include "app/viewer/window/viewer_loop.hpp"

namespace nacre {

Viewer::Viewer(const ViewerOptions& options)
    : options_(options),
      session_(options.session),
      player_(options.session),
      recording_(options.recorded),
      film_(options.video),
      time_(session_.settings.fps),
      started_(now()),
      event_log_(options.say) {
  scripted_ = !session_.events.empty();
  session_.events.clear();
  session_.duration = 0;
  if (recording_.has_file()) recording_.begin(session_, time_.fps(), 0);
  make_graphics();
  open();
  if (options_.video) options_.video->describe(options_.origin(session_, "video"));
  if (options_.welcome) ui_.welcome();
  told_ = session_;
}

ViewerResult Viewer::run() {
  try {
    while (!done() && !result_.interrupted) {
      if (window_) window_->poll(!film_.on(), patience());
      if (window_ && window_->should_close()) {
        window_->keep_open();
        try_to_quit();
        redraw_ = true;
      }
      interruptible([&] {
        frame();
        if (context_->lost()) begin_again();
      });
    }
  } catch (...) {
    write_recording();
    throw;
  }
  write_recording();
  finish();
  return std::move(result_);
}

void Viewer::make_graphics() {
  const Settings& settings = session_.settings;
  if (options_.offscreen) {
    context_ = make_offscreen_context(true);
  } else {
    auto window = std::make_unique<Window>("Nacre", settings.width, settings.height);
    window_ = window.get();
    window_->on_drop = [this](const std::vector<std::filesystem::path>& files) { dropped_ = files; };
    context_ = std::move(window);
  }
  result_.renderer = context_->renderer();
  result_.version = context_->version();
  imgui_.emplace(window_);
  painter_.emplace();
}

void Viewer::drop_graphics() {
  opening_.reset();
  left_.clear();
  thumbnails_.drop_textures();
  comparison_.close();
  open_.reset();  // before the context that all of it lives in
  frame_.reset();
  painter_.reset();
  imgui_.reset();
  window_ = nullptr;
  context_.reset();
}

void Viewer::begin_again() {
  options_.say("the graphics device was reset: drawing begins again");
  drop_graphics();
  make_graphics();
  open();
}

bool Viewer::done() const {
  // What has no window and no end of its own ends with the mesh.
  const bool settled = !window_ && options_.frames == 0 && options_.session.duration <= 0 && all_settled();
  return (quit_ && !saving_.on()) || settled || (!window_ && player_->ended()) ||
         (options_.frames > 0 && counted_ >= options_.frames);
}

void Viewer::frame() {
  const auto [width, height] = size();
  if (width <= 0 || height <= 0) return rest(now(), shortest_frame);  // minimised
  const double time = time_.seconds();
  std::vector<Screenshot> pictures = std::exchange(late_pictures_, {});
  for (Screenshot& each : player_->advance(time - played_since_, session_)) pictures.push_back(std::move(each));
  if (!dropped_.empty()) may_differ_ = true, open_dropped();
  const bool changed = take_changes();
  leave_lost_device();
  const bool advanced = advance_scene();
  if (scene().settle_knobs(session_)) settled_knobs_ = may_differ_ = true;
  if (comparison_.on() && comparison_.settle_knobs(session_)) settled_knobs_ = may_differ_ = true;
  if (options_.offscreen && !scene().failure().empty()) throw Error(scene().failure());
  const double begin = now();
  const DrawDemand::Shown shown = what_is_shown(width, height);
  const bool draws = needs_frame(begin, shown, changed || !pictures.empty());
  requests_ = {};
  if (draws) {
    if (!frame_ || frame_->width() != width || frame_->height() != height) frame_.emplace(width, height, samples());
    draw(width, height, last_ > 0 ? begin - last_ : 1.0 / 60);
    may_differ_ = true;
    divert_input();
    glFinish();
  }
  const double end = now();
  if (advanced && draws) add_to_video();
  follow_keyframes(advanced);
  if (!advanced) late_pictures_ = std::exchange(pictures, {});
  if (requests_.screenshot) pictures.push_back(*requests_.screenshot);
  for (const Screenshot& picture : pictures) attempt([&] { take_picture(picture); });
  const bool moved = session_.camera != told_.camera;  // by hand, or fitted, in this frame
  recording_.note(time, changed || moved ? &session_ : nullptr, pictures);
  if (draws) note_times(begin, end);
  count_time(begin, advanced);
  obey(requests_);
  tell_saved();
  if (window_ && draws) window_->swap();
  event_log_.tell(scene());
  if (window_) {
    window_->set_title(window_title(scene(), film_.from_menu()));
    attempt([&] { recording_.keep(); });
  }
  if (!draws) return;  // the loop waits for what the user does
  demand_.drawn(begin, end, shown);
  // Where nothing has to be waited for, it is filmed as fast as it will be shown.
  rest(begin, film_.from_menu() ? 1.0 / time_.fps() : waits() ? 0 : shortest_frame);
}

DrawDemand::Shown Viewer::what_is_shown(int width, int height) const {
  const SceneProgress progress = this->progress();
  return {{width, height},
          scene().version() + (comparison_.on() ? comparison_.scene().version() : 0),
          progress.stage.empty() ? "" : fmt::format("{} {:.3f}", progress.stage, progress.fraction),
          fmt::format("{} {} {} {}", scene().halted(), saving_.name(), scene().failure(), opening_.has_value())};
}

bool Viewer::needs_frame(double time, const DrawDemand::Shown& shown, bool changed) {
  if (!draws_on_demand()) return true;
  if (window_->is_minimised()) return false;
  const bool touched =
      std::exchange(redraw_, false) || changed || window_->touched() || session_.settings.orbit != 0 || list_play_;
  return demand_.due(time, shown, touched, ui_.animates());
}

bool Viewer::advance_scene() {
  const bool filming = film_.from_menu();
  bool advanced = !filming;
  const auto wait = [&](double patience) {
    advanced = scene().advance_and_wait(*options_.stop, patience);
    if (advanced && comparison_.on()) comparison_.advance_and_wait(scene(), *options_.stop);
  };
  if (!filming && waits()) return wait(endless), advanced;
  attempt([&] {
    if (filming && scene().failure().empty()) return wait(0.05);
    if (comparison_.on()) comparison_.advance(scene(), now());
    scene().advance(now());
  });
  if (const std::string failure = comparison_.take_failure(); !failure.empty()) show_error(failure);
  return advanced;
}

void Viewer::add_to_video() {
  if (!film_.on()) return;
  const bool from_menu = film_.from_menu();
  try {
    film_.add(frame_->read());
  } catch (const Error& error) {
    if (!window_) throw;
    show_error(error.what());
    if (!from_menu) result_.lost_video = error.what();
    set_lockstep(waits());
  }
}

void Viewer::draw_scene(Framebuffer& frame, const FreeArea& area, const std::array<float, 4>& background) {
  frame.bind();
  frame.clear(background);
  if (!framing_.ready()) return;
  const auto [first, second] = views(area);
  painter_->draw(frame, scene(), session_, turned_, first, comparison_.first_heading());
  if (second.width > 0) comparison_.draw(frame, session_, turned_, second);
}

void Viewer::draw(int width, int height, double seconds) {
  imgui_->begin(width, height, seconds, session_.settings.view);
  const FreeArea area = ui_.free_area(session_.settings.view, width, height);
  const auto [first, second] = views(area);
  area_ = areas_of(scene(), session_.settings.view, first).view;
  framing_.keep(session_, scene(), area_, options_.first_camera);
  draw_scene(*frame_, area, background_of(session_.settings));
  const bool at_second = second.width > 0 && imgui_->cursor()[0] >= float(second.x);
  Scene& pointed_scene = at_second ? comparison_.scene() : scene();
  const PointedView pointed{pointed_scene, areas_of(pointed_scene, session_.settings.view, at_second ? second : first)};
  if (session_.camera) move_by_hand(*session_.camera, pointed);
  const std::vector<RecentFile> recent = recent_files();
  const UiFacts facts{*open_.panel,
                      pointed,
                      progress(),
                      clock_,
                      result_.renderer,
                      recent,
                      undo_.can_undo(),
                      undo_.can_redo(),
                      recording_.on(),
                      film_.from_menu() ? film_.length() : "",
                      saving_.name(),
                      width,
                      height,
                      orbit(session_.camera.value_or(Camera()), turned_),
                      imgui_->chords(),
                      opening_.has_value(),
                      film_.on(),
                      keyframes_time(),
                      list_play_ && list_play_->films};
  requests_ = ui_.draw(session_, scene(), facts);
  imgui_->end();
  if (window_) frame_->show_in_window();
}

void Viewer::move_by_hand(Camera& camera, const PointedView& pointed) {
  const Camera seen = orbit(camera, turned_);
  Camera moved = seen;
  move_camera(moved, session_.settings.view.turning, pointed.areas.view, diameter_of(scene().seen()),
              [&](const Vec3d& from, const Vec3d& along) -> std::optional<Vec3d> {
                const std::optional<ProbeResult> met = pointed.scene.probe(from, along);
                return met ? std::optional(met->position) : std::nullopt;
              });
  if (moved == seen) return;
  camera = moved;
  turned_ = 0;
}

void Viewer::count_time(double frame_begin, bool advanced) {
  const double passed = last_ > 0 ? frame_begin - last_ : 0;
  last_ = frame_begin;
  if (!advanced) return;
  const Settings& settings = session_.settings;
  turned_ += settings.orbit * (waits() ? time_.add_frame() : time_.add_seconds(passed, settings.fps));
}

bool Viewer::take_changes() {
  const bool opened = take_opened();
  if (!std::exchange(may_differ_, false) && !opened && !scripted_) return false;
  std::optional<SessionEvent> change = session_change(told_, session_);
  if (change && change->input && !opened && divert_input()) change.reset();
  undo_.note(change ? &*change : nullptr, told_, session_, ImGuiLayer::busy());
  if (!change) return false;
  const bool by_user = !scripted_ && !std::exchange(settled_knobs_, false);
  if (by_user && changes_result(change->knobs)) unsaved_ = true;
  if (change->input && !opened)
    open();
  else if (!change->input && !change->knobs.empty())
    scene().set_settings(session_.settings, ChangedKnobs(change->knobs));
  if (change->input || !change->knobs.empty()) follow_comparison();
  told_ = session_;
  return true;
}

void Viewer::note_times(double begin, double end) {
  if (result_.frame_seconds.empty()) result_.first_frame = end - started_;
  if (framing_.ready() && result_.first_surface == 0) result_.first_surface = end - started_;
  if (scene().complete() && result_.first_texture == 0) result_.first_texture = end - started_;
  if (scene().complete() || !scene().failure().empty()) ++counted_;
  result_.frame_seconds.push_back(end - begin);
  clock_.add(end - begin);
}

void Viewer::finish() {
  if (options_.picture && frame_) result_.image = frame_->read();
  if (!options_.out.empty() && !result_.interrupted)
    scene().write_result(options_.out, options_.origin(session_, "out"));
  result_.shown = shown_session();
  keep_thumbnail();
  scene().finish();
  if (comparison_.on()) comparison_.scene().finish();
  const SceneTotals totals = scene().totals();
  result_.steps = totals.steps;
  result_.copied_bytes = totals.copied_bytes;
  result_.timers = totals.timers;
  result_.peak_bytes = totals.peak_bytes;
  result_.device_name = scene().device().name();
  result_.threads = scene().device().threads();
  result_.backend = scene().device().backend();
  result_.driver_messages = context_->messages();
  result_.filmed_frames = film_.frames();
  if (!result_.interrupted) film_.finish();
}

ViewerResult run_viewer(const ViewerOptions& options) { return Viewer(options).run(); }

}  // namespace nacre
