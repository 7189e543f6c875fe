// Nacre: the loop of the viewer. All that a user, a script or a file changes goes through one session; what differs from
// the last frame's is told to the scene, to the recorder, and can be taken back.
#include "app/viewer/viewer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "app/viewer/camera_control.hpp"
#include "app/viewer/captions.hpp"
#include "app/viewer/clip.hpp"
#include "app/viewer/panel.hpp"
#include "app/viewer/scene.hpp"
#include "compute/device/error.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/gl/window.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/recording.hpp"

namespace nacre {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::array<float, 4> background_of(const Settings& settings) {
  const Rgba paper = paper_of(settings.background);
  if (paper.a == 0) return {0, 0, 0, 0};
  return {float(paper.r) / 255, float(paper.g) / 255, float(paper.b) / 255, 1};
}

/// Of the middle of their bounding box to its corners.
double radius_of(const std::vector<Vec3d>& points) {
  if (points.empty()) return 0;
  Vec3d low = points.front(), high = low;
  for (const Vec3d& p : points) low = min(low, p), high = max(high, p);
  return 0.5 * length(high - low);
}

class Viewer {
 public:
  explicit Viewer(const ViewerOptions& options)
      : options_(options), session_(options.session), player_(options.session), started_(now()), last_(started_) {
    session_.events.clear();
    session_.duration = 0;
    if (options.recorded) recorder_.emplace(session_, session_.settings.fps);
    make_graphics();
    open();
  }

  ~Viewer() { drop_graphics(); }

  ViewerResult run() {
    while (!done()) {
      if (*options_.stop) throw Interrupted();
      if (window_) window_->poll();
      frame();
    }
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
    interface_.emplace(window_);
    captions_.emplace();
  }

  void drop_graphics() {
    scene_.reset();  // before the context that all of it lives in
    frame_.reset();
    captions_.reset();
    interface_.reset();
    window_ = nullptr;
    context_.reset();
  }

  void open() {
    scene_.reset();
    captions_->forget();
    said_ = 0;
    fitted_ = false;
    const SceneOptions options{options_.open_device, window_ || options_.live, waits()};
    scene_ = is_mesh_input(session_) ? make_mesh_scene(session_, options) : make_flow_scene(session_, options);
    told_ = session_;
  }

  bool done() const {
    const bool played = player_.duration() > 0 && !window_ && clock() > player_.duration();
    return quit_ || played || (options_.frames > 0 && counted_ >= options_.frames) ||
           (window_ && window_->should_close());
  }

  /// Seconds of the session: those of its frames where these wait for compute, else those that have passed.
  double clock() const {
    return waits() ? double(result_.frame_seconds.size()) / session_.settings.fps : now() - started_;
  }

  void frame() {
    const auto [width, height] = size();
    if (width <= 0 || height <= 0) return;  // minimised
    const double time = clock();
    std::vector<Screenshot> pictures = player_.advance(time, session_);
    if (!dropped_.empty()) open_dropped();
    take_changes();
    if (waits())
      scene_->advance_and_wait(*options_.stop);
    else
      scene_->advance(now());
    if (options_.offscreen && !scene_->failure().empty()) throw Error(scene_->failure());
    const double begin = now();
    fit_once(width, height);
    if (!frame_ || frame_->width() != width || frame_->height() != height) frame_.emplace(width, height, samples());
    draw(width, height, begin - last_);
    last_ = begin;
    glFinish();
    const double end = now();
    if (options_.video) options_.video->add(frame_->read());
    for (const Screenshot& picture : pictures) take_picture(picture);
    if (recorder_) recorder_->note(time, session_, pictures);
    note_times(begin, end);
    if (window_) window_->swap();
    tell_news();
    if (!waits()) rest(begin);
  }

  View view_of(int width, int height) const {
    const Settings& settings = session_.settings;
    View view;
    view.camera = orbit(session_.camera.value_or(Camera()), settings.orbit * double(result_.frame_seconds.size()));
    view.width = width;
    view.height = height;
    view.light =
        turned_light(flow_light(view.camera), view.camera, settings.look.light_azimuth, settings.look.light_height);
    view.clip = clip_plane(settings.look, scene_->corners());
    view.ambient = float(settings.look.ambient);
    view.extent = 2 * radius_of(scene_->corners()) + length(view.camera.eye - view.camera.target);
    return view;
  }

  void draw_scene(Framebuffer& frame, const std::array<float, 4>& background) {
    frame.bind();
    frame.clear(background);
    if (!fitted_) return;
    const View view = view_of(frame.width(), frame.height());
    scene_->draw(view);
    captions_->draw(*scene_, view, session_.settings);
  }

  void draw(int width, int height, double seconds) {
    draw_scene(*frame_, background_of(session_.settings));
    interface_->begin(width, height, seconds);
    if (control_camera(session_, *scene_, state_, width, height).quit) quit_ = true;
    draw_panel(state_, session_, *scene_, clock_, result_.renderer);
    interface_->end();
    if (window_) {
      frame_->show_in_window();
      glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
  }

  void take_picture(const Screenshot& picture) {
    Image image;
    if (picture.panel) {
      image = frame_->read();
    } else {
      Framebuffer large(frame_->width() * picture.scale, frame_->height() * picture.scale, 4);
      draw_scene(large, picture.transparent ? std::array<float, 4>{0, 0, 0, 0} : background_of(session_.settings));
      image = large.read();
    }
    write_png(picture.file, image);
    result_.pictures.push_back(picture.file);
  }

  std::array<int, 2> size() const {
    if (window_) return window_->pixels();
    return {session_.settings.width, session_.settings.height};
  }

  /// A display without vertical synchronisation, or none at all, shall not cost compute its cores.
  static void rest(double begin) {
    constexpr double shortest_frame = 1.0 / 60;
    const double left = shortest_frame - (now() - begin);
    if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
  }

  /// Per pixel. Software renderers pay for each: there, frames that somebody waits for have one.
  int samples() const {
    const bool software = result_.renderer.find("llvmpipe") != std::string::npos;
    return session_.settings.samples > 1 && (waits() || !software) ? 4 : 1;
  }

  bool waits() const { return options_.offscreen && !options_.live; }

  /// What has been changed since the last frame: by the user, the script, a file.
  void take_changes() {
    const std::optional<SessionEvent> change = session_change(told_, session_);
    if (!change) return;
    if (change->input)
      open();
    else if (!change->knobs.empty())
      scene_->set_settings(session_.settings);
    told_ = session_;
  }

  void fit_once(int width, int height) {
    if (fitted_ || scene_->corners().empty()) return;
    if (!session_.camera) {
      Settings settings = session_.settings;
      settings.width = width;
      settings.height = height;
      session_.camera = options_.first_camera(settings, scene_->corners());
      if (recorder_) recorder_->accept_camera(*session_.camera);
    }
    fitted_ = true;
  }

  void open_dropped() {
    static_cast<SessionInput&>(session_) = {std::exchange(dropped_, {}), "", 0};
    session_.camera.reset();
  }

  void note_times(double begin, double end) {
    if (result_.frame_seconds.empty()) result_.first_frame = end - started_;
    if (fitted_ && result_.first_surface == 0) result_.first_surface = end - started_;
    if (scene_->complete() && result_.first_texture == 0) result_.first_texture = end - started_;
    if (scene_->complete() || !scene_->failure().empty()) ++counted_;
    result_.frame_seconds.push_back(end - begin);
    clock_.add(end - begin);
  }

  /// Warnings and failures, each once.
  void tell_news() {
    const std::vector<std::string>& warnings = scene_->warnings();
    for (; said_ < warnings.size(); ++said_) options_.say("warning: " + warnings[said_]);
    if (scene_->failure() != said_failure_) {
      said_failure_ = scene_->failure();
      if (!said_failure_.empty()) options_.say(said_failure_);
    }
    const std::string remark = scene_->remark();
    if (!remark.empty() && !std::exchange(said_remark_, true)) options_.say(remark);
  }

  void finish() {
    if (options_.picture && frame_) result_.image = frame_->read();
    if (recorder_) result_.recording = recorder_->recording(clock());
    if (!options_.out.empty()) scene_->write_result(options_.out);
    scene_->finish();
    result_.steps = scene_->steps();
    result_.copied_bytes = scene_->copied_bytes();
    result_.timers = scene_->timers();
    result_.peak_bytes = scene_->peak_bytes();
    result_.device_name = scene_->device().name();
    result_.backend = scene_->device().backend();
    result_.driver_messages = context_->messages();
  }

  const ViewerOptions& options_;
  Session session_, told_;
  SessionPlayer player_;
  std::optional<SessionRecorder> recorder_;
  double started_, last_;
  std::unique_ptr<Context> context_;
  Window* window_ = nullptr;  ///< the context, where it is one
  std::optional<Interface> interface_;
  std::optional<Captions> captions_;
  std::optional<Framebuffer> frame_;
  std::unique_ptr<Scene> scene_;
  PanelState state_;
  FrameClock clock_;
  bool fitted_ = false, quit_ = false, said_remark_ = false;
  int counted_ = 0;
  std::size_t said_ = 0;
  std::string said_failure_;
  std::vector<std::filesystem::path> dropped_;
  ViewerResult result_;
};

}  // namespace

ViewerResult run_viewer(const ViewerOptions& options) { return Viewer(options).run(); }

}  // namespace nacre
