// Nacre: the loop of the viewer. All that a user, a script or a file changes goes through one session. What differs
// from the last frame's is found once a frame, told to the scene and to the recorder, and can be undone.
#include "app/viewer/window/viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/viewer/panel/ui.hpp"
#include "app/viewer/scene/captions.hpp"
#include "app/viewer/scene/framing.hpp"
#include "app/viewer/scene/scene.hpp"
#include "app/viewer/scene/scene_view.hpp"
#include "app/viewer/scene/worker.hpp"
#include "app/viewer/window/camera_control.hpp"
#include "app/viewer/window/draw_demand.hpp"
#include "app/viewer/window/event_log.hpp"
#include "app/viewer/window/film.hpp"
#include "app/viewer/window/imgui_layer.hpp"
#include "app/viewer/window/kept_recording.hpp"
#include "app/viewer/window/recent_files.hpp"
#include "app/viewer/window/saving.hpp"
#include "app/viewer/window/session_clock.hpp"
#include "app/viewer/window/undo.hpp"
#include "compute/device/error.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/gl/window.hpp"
#include "engine/picture/png.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

class Viewer {
 public:
  explicit Viewer(const ViewerOptions& options)
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
    told_ = session_;
  }

  ~Viewer() { drop_graphics(); }

  ViewerResult run() {
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

 private:
  void make_graphics() {
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
    captions_.emplace();
  }

  /// An interruption ends a window as the user does, with all that is written then; without one it is the caller's.
  template <class Work>
  void interruptible(const Work& work) {
    try {
      if (*options_.stop) throw Interrupted();
      work();
    } catch (const Interrupted&) {
      if (!window_) throw;
      result_.interrupted = true;
    }
  }

  void try_to_quit() {
    std::vector<std::string> reasons = reasons_to_stay();
    if (reasons.empty() || ui_.asks_quit())
      quit_ = true;
    else
      ui_.ask_quit(std::move(reasons));
  }

  /// What would be lost, a sentence each. A file that is being written is waited for.
  std::vector<std::string> reasons_to_stay() const {
    std::vector<std::string> reasons;
    const SceneProgress progress = scene().progress();
    if (!progress.stage.empty())
      reasons.push_back(fmt::format("The computation ({}) has not finished.", progress.stage));
    if (film_.from_menu()) reasons.push_back("A video is being recorded.");
    if (recording_.on() && !recording_.has_file()) reasons.push_back("Your actions are being recorded.");
    if (unsaved_ && !recording_.has_file())
      reasons.push_back("You have changed parameters and saved neither session nor result.");
    return reasons;
  }

  void drop_graphics() {
    open_.reset();  // before the context that all of it lives in
    frame_.reset();
    captions_.reset();
    imgui_.reset();
    window_ = nullptr;
    context_.reset();
  }

  /// The graphics device was reset, and all that lay on it is gone. The session is not.
  void begin_again() {
    options_.say("the graphics device was reset: drawing begins again");
    drop_graphics();
    make_graphics();
    open();
  }

  void open() {
    if (const std::string lost = saving_.drop(); !lost.empty()) show_error(lost);
    open_.reset();
    captions_->forget();
    event_log_.forget();
    framing_.forget();
    // A number of frames is for headless runs to compare with: these do not begin again after the last time.
    const SceneOptions options{spare_ ? options_.open_spare_device : options_.open_device, options_.frames == 0,
                               waits(), !waits(), options_.stop};
    for (const auto& file : session_.inputs)
      if (window_) recent_.add(file);
    open_ = open_scene(session_, options);
  }

  Scene& scene() const { return *open_.scene; }

  /// A GPU that has failed does not come back while the program runs. The session is as it was.
  void leave_lost_device() {
    const std::string why = scene().lost_device();
    if (why.empty() || spare_ || !window_) return;
    spare_ = true;
    show_error(
        fmt::format("{} stopped working ({}); the processor computes from now on", scene().device().name(), why));
    open();
  }

  bool done() const {
    // What has no window and no end of its own ends with the mesh.
    const bool settled = !window_ && options_.frames == 0 && options_.session.duration <= 0 && scene().settled();
    return (quit_ && !saving_.on()) || settled || (!window_ && player_->ended()) ||
           (options_.frames > 0 && counted_ >= options_.frames);
  }

  void frame() {
    const auto [width, height] = size();
    if (width <= 0 || height <= 0) return rest(now(), shortest_frame);  // minimised
    const double time = time_.seconds();
    std::vector<Screenshot> pictures = player_->advance(time - played_since_, session_);
    if (!dropped_.empty()) open_dropped();
    const bool changed = take_changes();
    leave_lost_device();
    const bool advanced = advance_scene();
    if (scene().settle_knobs(session_)) settled_knobs_ = true;
    if (options_.offscreen && !scene().failure().empty()) throw Error(scene().failure());
    const double begin = now();
    const DrawDemand::Shown shown = what_is_shown(width, height);
    const bool draws = needs_frame(begin, shown, changed || !pictures.empty());
    requests_ = {};
    if (draws) {
      if (!frame_ || frame_->width() != width || frame_->height() != height) frame_.emplace(width, height, samples());
      draw(width, height, last_ > 0 ? begin - last_ : 1.0 / 60);
      glFinish();
    }
    const double end = now();
    if (advanced && draws) add_to_video();
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

  /// A window is drawn where it has changed; not so where frames are counted or filmed.
  bool draws_on_demand() const { return window_ && options_.frames == 0 && !film_.on(); }

  /// How long the loop waits for the user where nothing has to be drawn, seconds: what compute tells is looked after.
  double patience() const {
    if (!draws_on_demand()) return 0;
    return !scene().settled() && !scene().halted() ? shortest_frame : 0.1;
  }

  DrawDemand::Shown what_is_shown(int width, int height) const {
    const SceneProgress progress = scene().progress();
    return {{width, height},
            scene().version(),
            progress.stage.empty() ? "" : fmt::format("{} {:.3f}", progress.stage, progress.fraction),
            fmt::format("{} {} {}", scene().halted(), saving_.name(), scene().failure())};
  }

  bool needs_frame(double time, const DrawDemand::Shown& shown, bool changed) {
    if (!draws_on_demand()) return true;
    if (window_->is_minimised()) return false;
    const bool touched = std::exchange(redraw_, false) || changed || window_->touched() || session_.settings.orbit != 0;
    return demand_.due(time, shown, touched, ui_.animates());
  }

  /// False: the frame that waits for compute is still to come, and what is drawn until then is for the user alone.
  bool advance_scene() {
    const bool filming = film_.from_menu();
    if (!filming && waits()) return scene().advance_and_wait(*options_.stop, endless);
    bool advanced = !filming;
    attempt([&] {
      if (filming && scene().failure().empty())
        advanced = scene().advance_and_wait(*options_.stop, 0.05);
      else
        scene().advance(now());
    });
    return advanced;
  }

  /// A video that cannot be written ends; what is seen in a window goes on.
  void add_to_video() {
    if (!film_.on()) return;
    const bool from_menu = film_.from_menu();
    try {
      film_.add(frame_->read());
    } catch (const Error& error) {
      if (!window_) throw;
      show_error(error.what());
      if (!from_menu) result_.lost_video = error.what();
      scene().set_lockstep(waits());
    }
  }

  void draw_scene(Framebuffer& frame, const FreeArea& area, const std::array<float, 4>& background) {
    frame.bind();
    frame.clear(background);
    if (!framing_.ready()) return;
    frame.bind_part(area.x, frame.height() - area.y - area.height, area.width, area.height);
    const View view = scene_view(session_, scene().corners(), turned_, area.width, area.height);
    scene().draw(view);
    captions_->draw(scene(), view, session_.settings);
    frame.bind();
  }

  void draw(int width, int height, double seconds) {
    imgui_->begin(width, height, seconds, session_.settings.view);
    const FreeArea area = ui_.free_area(session_.settings.view, width, height);
    area_ = area;
    framing_.keep(session_, scene(), area, options_.first_camera);
    draw_scene(*frame_, area, background_of(session_.settings));
    if (session_.camera) move_by_hand(*session_.camera, area);
    const UiFacts facts{*open_.panel,     clock_,
                        result_.renderer, recent_.files(),
                        undo_.can_undo(), undo_.can_redo(),
                        recording_.on(),  film_.from_menu() ? film_.length() : "",
                        saving_.name(),   width,
                        height,           orbit(session_.camera.value_or(Camera()), turned_),
                        imgui_->chords()};
    requests_ = ui_.draw(session_, scene(), facts);
    imgui_->end();
    if (window_) frame_->show_in_window();
  }

  /// What the hand takes hold of is what is seen, as far as it has turned.
  void move_by_hand(Camera& camera, const FreeArea& area) {
    const Camera seen = orbit(camera, turned_);
    Camera moved = seen;
    move_camera(moved, session_.settings.view.turning, area, diameter_of(scene().seen()),
                [this](const Vec3d& from, const Vec3d& along) -> std::optional<Vec3d> {
                  const std::optional<ProbeResult> met = scene().probe(from, along);
                  return met ? std::optional(met->position) : std::nullopt;
                });
    if (moved == seen) return;
    camera = moved;
    turned_ = 0;
  }

  /// From where it is seen now, as far as it has turned.
  void fit_what_is_seen() {
    session_.camera = orbit(*session_.camera, std::exchange(turned_, 0));
    framing_.fit(session_, scene(), area_);
  }

  void take_picture(const Screenshot& picture) {
    Image image;
    if (picture.panel) {
      image = frame_->read();
    } else {
      Framebuffer large(frame_->width() * picture.scale, frame_->height() * picture.scale, 4);
      draw_scene(large, {0, 0, large.width(), large.height()},
                 picture.transparent ? std::array<float, 4>{0, 0, 0, 0} : background_of(session_.settings));
      image = large.read();
    }
    write_png(picture.file, image);
    result_.pictures.push_back(picture.file);
  }

  /// And turns a camera that orbits: by as much in a second as in a second of a video.
  void count_time(double frame_begin, bool advanced) {
    const double passed = last_ > 0 ? frame_begin - last_ : 0;
    last_ = frame_begin;
    if (!advanced) return;
    const Settings& settings = session_.settings;
    turned_ += settings.orbit * (waits() ? time_.add_frame() : time_.add_seconds(passed, settings.fps));
  }

  /// In a window an error is a line for the user, who goes on; without one it ends the program.
  template <class Action>
  void attempt(const Action& action) {
    if (!window_) return action();
    try {
      action();
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& error) {
      show_error(error.what());
    }
  }

  void show_error(const std::string& line) {
    redraw_ = true;
    ui_.show_error(line);
    event_log_.add_error(line);
  }

  void obey(const UiRequests& requests) {
    if (requests.quit) try_to_quit();
    if (requests.undo) undo_.undo(session_);
    if (requests.redo) undo_.redo(session_);
    if (requests.cancel) scene().cancel();
    if (requests.resume) scene().resume();
    if (session_.camera && requests.fit) fit_what_is_seen();
    if (session_.camera && !requests.look_from.empty())
      framing_.look_from(requests.look_from, session_, scene(), area_);
    if (requests.load_session) attempt([&] { load_session(*requests.load_session); });
    if (requests.save_session) attempt([&] { save(*requests.save_session, session_text(session_)); });
    if (requests.save_result) attempt([&] { saving_.begin(scene(), *requests.save_result); });
    obey_recording(requests);
  }

  void tell_saved() {
    const std::optional<Saving::Outcome> saved = saving_.poll(scene());
    if (!saved) return;
    redraw_ = true;
    if (saved->failure.empty()) unsaved_ = false;
    if (saved->failure.empty())
      ui_.show_note("saved " + saved->file.string());
    else
      show_error(saved->file.string() + " was not saved: " + saved->failure);
  }

  void obey_recording(const UiRequests& requests) {
    if (requests.record) recording_.begin(session_, session_.settings.fps, time_.seconds());
    if (requests.save_recording && recording_.on())
      attempt([&] {
        note_last_changes();
        save(*requests.save_recording, session_text(recording_.recording()));
        recording_.end();
      });
    if (requests.film)
      attempt([&] {
        film_.begin(*requests.film, session_.settings.fps, options_.stop);
        time_.set_fps(session_.settings.fps);
        scene().set_lockstep(true);
      });
    if (requests.end_film && film_.from_menu()) {
      attempt([&] {
        film_.finish();
        ui_.show_note(fmt::format("saved {} ({})", film_.file().string(), film_.length()));
      });
      scene().set_lockstep(waits());
    }
  }

  /// A session or a recording.
  void save(const std::filesystem::path& file, const std::string& text) {
    OutputFile out(file);
    out.write(text);
    out.commit();
    unsaved_ = false;
    ui_.show_note("saved " + file.string());
  }

  /// Its state; where it is a recording, that is played.
  void load_session(const std::filesystem::path& file) {
    Session loaded = read_session(file);
    options_.check(loaded);
    player_.emplace(loaded);
    played_since_ = time_.seconds();
    scripted_ = !loaded.events.empty();
    loaded.events.clear();
    loaded.duration = 0;
    if (!loaded.camera) framing_.forget();
    session_ = std::move(loaded);
    recent_.add(file);
  }

  std::array<int, 2> size() const {
    if (window_) return window_->pixels();
    return {session_.settings.width, session_.settings.height};
  }

  /// Per pixel. Software renderers pay for each: there, frames that somebody waits for have one.
  int samples() const {
    const bool software = result_.renderer.find("llvmpipe") != std::string::npos;
    return session_.settings.samples > 1 && (waits() || !software) ? 4 : 1;
  }

  bool waits() const { return (options_.offscreen && !options_.live) || film_.on(); }

  /// What has been changed since the last frame: by the user, the script, a file. True where anything has.
  bool take_changes() {
    const std::optional<SessionEvent> change = session_change(told_, session_);
    undo_.note(change ? &*change : nullptr, told_, session_, ImGuiLayer::busy());
    if (!change) return false;
    const bool by_user = !scripted_ && !std::exchange(settled_knobs_, false);
    if (by_user && changes_result(change->knobs)) unsaved_ = true;
    if (change->input)
      open();
    else if (!change->knobs.empty())
      scene().set_settings(session_.settings, ChangedKnobs(change->knobs));
    told_ = session_;
    return true;
  }

  void note_last_changes() {
    if (recording_.on() && session_change(told_, session_)) recording_.note_last(session_);
  }

  void write_recording() {
    note_last_changes();
    recording_.write();
  }

  void open_dropped() {
    if (dropped_.size() == 1 && dropped_[0].extension() == ".json") {
      const std::vector<std::filesystem::path> file = std::exchange(dropped_, {});
      return attempt([&] { load_session(file[0]); });
    }
    static_cast<SessionInput&>(session_) = {std::exchange(dropped_, {}), "", 0};
    session_.camera.reset();
  }

  void note_times(double begin, double end) {
    if (result_.frame_seconds.empty()) result_.first_frame = end - started_;
    if (framing_.ready() && result_.first_surface == 0) result_.first_surface = end - started_;
    if (scene().complete() && result_.first_texture == 0) result_.first_texture = end - started_;
    if (scene().complete() || !scene().failure().empty()) ++counted_;
    result_.frame_seconds.push_back(end - begin);
    clock_.add(end - begin);
  }

  void finish() {
    if (options_.picture && frame_) result_.image = frame_->read();
    if (!options_.out.empty() && !result_.interrupted) scene().write_result(options_.out);
    scene().finish();
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

  const ViewerOptions& options_;
  Session session_, told_;
  std::optional<SessionPlayer> player_;
  KeptRecording recording_;
  Film film_;
  Saving saving_;
  SessionClock time_;
  double started_, last_ = 0;  ///< on the machine's clock
  double turned_ = 0;          ///< degrees, of a camera that orbits
  double played_since_ = 0;    ///< on the session's clock
  std::unique_ptr<Context> context_;
  Window* window_ = nullptr;  ///< the context, where it is one
  std::optional<ImGuiLayer> imgui_;
  std::optional<Captions> captions_;
  std::optional<Framebuffer> frame_;
  OpenScene open_;
  Ui ui_;
  Undo undo_;
  RecentFiles recent_;
  UiRequests requests_;
  Framing framing_;
  FreeArea area_;
  FrameClock clock_;
  DrawDemand demand_;
  bool quit_ = false, spare_ = false;
  bool redraw_ = false;         ///< the window has something to tell
  bool unsaved_ = false;        ///< the user has changed what a result depends on
  bool scripted_ = false;       ///< changes are those of a recording
  bool settled_knobs_ = false;  ///< the next change is the data's
  int counted_ = 0;
  EventLog event_log_;
  std::vector<std::filesystem::path> dropped_;
  ViewerResult result_;
};

}  // namespace

ViewerResult run_viewer(const ViewerOptions& options) { return Viewer(options).run(); }

}  // namespace nacre
