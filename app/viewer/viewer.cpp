// Nacre: the loop of the viewer.
#include "app/viewer/viewer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "app/viewer/camera_control.hpp"
#include "app/viewer/panel.hpp"
#include "compute/device/error.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/gl/window.hpp"
#include "engine/render/axes_pass.hpp"

namespace nacre {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::array<float, 4> background_of(const Settings& settings) {
  if (settings.background == "transparent") return {0, 0, 0, 0};
  const int rgb = std::stoi(settings.background.substr(1), nullptr, 16);
  return {float(rgb >> 16 & 255) / 255, float(rgb >> 8 & 255) / 255, float(rgb & 255) / 255, 1};
}

class Viewer {
 public:
  explicit Viewer(const ViewerOptions& options) : options_(options), started_(now()), last_(started_) {
    const Settings& settings = options.session.settings;
    if (options.offscreen) {
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
    axes_.emplace();
    state_.settings = settings;
    state_.visible = options.panel;
    open(options.session);
  }

  ~Viewer() {
    scene_.reset();  // before the context that all of it lives in
    frame_.reset();
    axes_.reset();
    interface_.reset();
  }

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
  void open(Session session) {
    scene_.reset();
    fitted_ = false;
    said_ = 0;
    session.settings = state_.settings;
    const bool loop = window_ || options_.live;  // a replay gives what headless runs give
    scene_.emplace(std::move(session), options_.open_device(), loop);
    scene_->steps_per_second = std::max(1, state_.settings.fps);
  }

  bool done() const {
    return quit_ || (options_.frames > 0 && counted_ >= options_.frames) || (window_ && window_->should_close());
  }

  void frame() {
    const auto [width, height] = size();
    if (width <= 0 || height <= 0) return;  // minimised
    if (!dropped_.empty()) open_dropped();
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
    note_times(begin, end);
    if (window_) window_->swap();
    tell_news();
    if (!waits()) rest(begin);
  }

  void draw(int width, int height, double seconds) {
    frame_->bind();
    frame_->clear(background_of(state_.settings));
    interface_->begin(width, height, seconds);
    if (control_camera(camera_, *scene_, state_, width, height).quit) quit_ = true;
    View view;
    view.camera = orbit(camera_, state_.settings.orbit * double(result_.frame_seconds.size()));
    view.width = width;
    view.height = height;
    view.light = flow_light(view.camera);
    view.extent = 2 * scene_->radius() + length(view.camera.eye - view.camera.target);
    if (fitted_) {
      scene_->draw(view);
      if (state_.settings.legend) axes_->draw(view, window_ ? window_->scale() : 1);
    }
    if (draw_panel(state_, *scene_, clock_, result_.renderer)) scene_->set_parameters(state_.settings.flow);
    if (window_) {
      frame_->show_in_window();
      glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    interface_->end();
  }

  std::array<int, 2> size() const {
    if (window_) return window_->pixels();
    return {state_.settings.width, state_.settings.height};
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
    return state_.settings.samples > 1 && (waits() || !software) ? 4 : 1;
  }

  bool waits() const { return options_.offscreen && !options_.live; }

  void fit_once(int width, int height) {
    if (fitted_ || scene_->corners().empty()) return;
    Settings settings = state_.settings;
    settings.width = width;
    settings.height = height;
    camera_ = options_.first_camera(settings, scene_->corners());
    fitted_ = true;
  }

  void open_dropped() {
    Session session;
    session.inputs = std::exchange(dropped_, {});
    open(std::move(session));
  }

  void note_times(double begin, double end) {
    if (result_.frame_seconds.empty()) result_.first_frame = end - started_;
    if (fitted_ && result_.first_surface == 0) result_.first_surface = end - started_;
    if (scene_->textured() && result_.first_texture == 0) result_.first_texture = end - started_;
    if (scene_->textured() || !scene_->failure().empty()) ++counted_;
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
    scene_->worker().finish();
    result_.steps = scene_->steps();
    result_.copied_bytes = scene_->copied_bytes();
    result_.timers = scene_->worker().timers();
    result_.peak_bytes = scene_->worker().peak_bytes();
    result_.device_name = scene_->worker().device().name();
    result_.backend = scene_->worker().device().backend();
    result_.driver_messages = context_->messages();
  }

  const ViewerOptions& options_;
  double started_, last_;
  std::unique_ptr<Context> context_;
  Window* window_ = nullptr;  ///< the context, where it is one
  std::optional<Interface> interface_;
  std::optional<AxesPass> axes_;
  std::optional<Framebuffer> frame_;
  std::optional<FlowScene> scene_;
  PanelState state_;
  FrameClock clock_;
  Camera camera_;
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
