// Nacre: `nacre view`: the words of the viewer. OpenGL begins in app/viewer, which a headless build leaves out.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/picture_words.hpp"
#include "app/run.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/knobs.hpp"
#include "engine/scene/prepare.hpp"
#if NACRE_HAS_VIEWER
#include "app/viewer/scene.hpp"
#include "app/viewer/viewer.hpp"
#endif

namespace nacre {
namespace {

struct ViewOptions {
  CommonOptions common;
  InputWords input;
  std::string image;
  int frames = 0;
  bool offscreen = false, live = false, panel = false, no_panel = false;
};

#if NACRE_HAS_VIEWER

constexpr const char* welcome_sample = "torus";
constexpr int welcome_detail = 128;      // reads in a moment
constexpr int welcome_resolution = 512;  // and moves soon after

Session view_session(const ViewOptions& options, const KnobOptions& knobs) {
  InputWords words = options.input;
  if (words.files.empty() && words.sample.empty() && options.common.session.empty()) {
    words.sample = welcome_sample;
    if (words.detail == 0) words.detail = welcome_detail;
  }
  const bool own_resolution = !options.common.session.empty() || knobs.given("resolution", options.common.set);
  return asked_session(options.common, words, knobs, "view", [&](Settings& settings) {
    if (!own_resolution) settings.flow.resolution = welcome_resolution;
  });
}

void check_view_words(const ViewOptions& options, const Settings& settings) {
  checked_words([&] {
    colormap(settings.colormap);
    if (settings.vectors.starts_with('@')) choose_vectors({}, settings.vectors);
  });
  check_picture_words(settings);
  if (options.offscreen && options.frames == 0 && options.image.empty())
    throw UsageError("--offscreen has nothing to do: give --image FILE.png or --frames-count N");
  if (options.live && !options.offscreen) throw UsageError("--live goes with --offscreen: a window never waits");
}

nlohmann::json frame_report(const ViewerResult& result) {
  std::vector<double> seconds = result.frame_seconds;
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return seconds.empty() ? 0 : 1e3 * seconds[std::size_t(share * double(seconds.size() - 1))];
  };
  return {{"frames", seconds.size()},
          {"frame_ms", {{"median", at(0.5)}, {"min", at(0)}, {"max", at(1)}, {"percentile_95", at(0.95)}}},
          {"first_frame_seconds", result.first_frame},
          {"first_surface_seconds", result.first_surface},
          {"first_texture_seconds", result.first_texture},
          {"steps", result.steps},
          {"copied_bytes", result.copied_bytes},
          {"opengl", {{"renderer", result.renderer}, {"version", result.version}}},
          {"driver_messages", result.driver_messages}};
}

void run_view(const ViewOptions& options, const KnobOptions& knobs) {
  ViewerOptions viewer;
  viewer.session = view_session(options, knobs);
  const Settings& settings = viewer.session.settings;
  check_view_words(options, settings);
  if (!options.common.save_session.empty()) write_text(options.common.save_session, session_text(viewer.session));
  viewer.open_device = [&] { return open_device(options.common); };
  viewer.offscreen = options.offscreen;
  viewer.live = options.live;
  viewer.session.settings.look.panel = options.offscreen ? options.panel : !options.no_panel;
  const bool flow = !is_mesh_input(viewer.session);  // a mesh is done when it is done
  viewer.frames = options.frames > 0          ? options.frames
                  : options.offscreen && flow ? std::max(1, settings.flow.steps)
                                              : 0;
  viewer.picture = !options.image.empty();
  viewer.stop = &interrupt_flag();
  viewer.first_camera = [](const Settings& s, const std::vector<Vec3d>& corners) { return read_camera(s, corners); };
  viewer.say = [&](const std::string& line) { say(options.common, line); };
  const ViewerResult result = run_viewer(viewer);

  std::vector<std::string> outputs;
  if (!options.image.empty()) {
    if (result.image.pixels.empty()) throw Error("no frame was drawn", "", "keep the window open for longer");
    write_png(options.image, result.image);
    outputs.push_back(options.image);
  }
  nlohmann::json report;
  report["nacre"] = version;
  report["command"] = "view";
  report["device"] = {{"backend", result.backend}, {"name", result.device_name}};
  report["stages"] = nlohmann::json::array();
  for (const StageTimers::Stage& stage : result.timers.stages())
    report["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}, {"calls", stage.calls}});
  report["memory"] = {{"device_peak_bytes", result.peak_bytes}};
  report["parameters"] = knob_values(settings);
  report["view"] = frame_report(result);
  write_report(options.common, std::move(report), outputs);
  print_outputs(outputs);
}

#else

void run_view(const ViewOptions&, const KnobOptions&) {
  throw Error("this build has no viewer", "its libraries were not found, or it was switched off",
              "run ./dev setup and build again, or use nacre flow and nacre mesh");
}

#endif

}  // namespace

void add_view_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("view", "the desktop viewer; without a FILE it shows a sample");
  auto options = std::make_shared<ViewOptions>();
  add_input_options(*command, options->input, "surface with vectors; several files are one series",
                    "triangle edges along the sample's longest side (0: its own)");
  command->add_flag("--offscreen", options->offscreen, "draw without a display (EGL)");
  command->add_option("--image", options->image, "write the last frame as PNG");
  command
      ->add_option("--frames-count", options->frames,
                   "end after N frames with the texture (offscreen: one for each step)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--live", options->live, "offscreen: frames do not wait for compute, as in a window");
  command->add_flag("--panel", options->panel, "offscreen: draw the panel, too");
  command->add_flag("--no-panel", options->no_panel, "begin without the panel");
  add_common_options(*command, options->common);
  auto knob_options = std::make_shared<KnobOptions>(*command, "view");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_view(*options, *knob_options); }; });
}

}  // namespace nacre
