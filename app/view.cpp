// Nacre: `nacre view`: the options of the viewer. OpenGL begins in app/viewer, which a headless build leaves out.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/mesh_run.hpp"
#include "app/picture_options.hpp"
#include "app/run.hpp"
#include "engine/io/named_files.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/png.hpp"
#include "engine/picture/video.hpp"
#include "engine/run/origin.hpp"
#include "engine/run/presets.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/session/compared.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/prepare.hpp"
#if NACRE_HAS_VIEWER
#include "app/viewer/scene/scene.hpp"
#include "app/viewer/scene/view_defaults.hpp"
#include "app/viewer/window/viewer.hpp"
#endif

namespace nacre {
namespace {

struct ViewOptions {
  CommonOptions common;
  InputOptions input;
  std::string script, image, record, save_recording, out, preset;
  int frames = 0;
  bool offscreen = false, live = false;
};

#if NACRE_HAS_VIEWER

constexpr const char* welcome_sample = "torus";
constexpr int welcome_detail = 128;  // reads in a moment

/// The preset is for volumes: its constants are those of meshing.
void apply_preset_kernel(const CommonOptions& common, const KnobOptions& knobs, Session& session) {
  if (!is_mesh_input(session)) throw UsageError("--preset source is for volumes: it sets the constants of meshing");
  if (!knobs.given("kernel", common.set)) apply_thesis_kernel(session.settings, is_cut_at_isovalues(session));
}

bool has_no_input(const ViewOptions& options) {
  return options.input.files.empty() && options.input.sample.empty() && options.common.session.empty() &&
         options.script.empty();
}

/// A session is the state that it begins with; a script is played.
Session view_session(const ViewOptions& options, const KnobOptions& knobs) {
  CommonOptions common = options.common;
  if (!options.script.empty()) common.session = options.script;
  InputOptions input = options.input;
  if (input.files.empty() && input.sample.empty() && common.session.empty()) {
    input.sample = welcome_sample;
    if (input.detail == 0) input.detail = welcome_detail;
  }
  const bool own_resolution = !common.session.empty() || knobs.given("resolution", common.set);
  Session session = requested_session(common, input, knobs, "view", [&](Settings& settings) {
    if (!own_resolution) settings.flow.resolution = view_defaults().flow.resolution;
    if (options.preset == "source") apply_thesis_preset(settings);
  });
  if (options.preset == "source") apply_preset_kernel(options.common, knobs, session);
  if (options.script.empty()) return session;
  const Session script = read_session(options.script);
  if (script.events.empty() && script.duration == 0)
    throw Error(options.script + " has nothing to play", "it has neither events nor a duration",
                "give it to --session, or write events into it");
  session.events = script.events;
  session.duration = script.duration;
  return session;
}

void check_view_options(const ViewOptions& options) {
  const bool does = options.frames > 0 || !options.image.empty() || !options.script.empty() ||
                    !options.record.empty() || !options.save_recording.empty() || !options.out.empty();
  if (options.offscreen && !does)
    throw UsageError(
        "--offscreen has nothing to do: give --script, --record, --image FILE.png, --out FILE or --frames-count N");
  if (options.live && !options.offscreen) throw UsageError("--live needs --offscreen: a window never waits");
  if (options.live && !options.record.empty())
    throw UsageError("use --live or --record, not both: the frames of a video wait for the computation");
  if (!options.script.empty() && !options.common.session.empty())
    throw UsageError("use --session or --script, not both: a script also has inputs, knobs and a camera");
  check_output(options.image, "--image", ".png");
  check_output(options.out, "--out", "");
  check_output(options.save_recording, "--save-recording", "");
  check_output(options.common.save_session, "--save-session", "");
  check_output(options.common.report, "--report", "");
}

void check_names(const Session& session) {
  const auto names = [](const auto& known, const std::string& name) {
    return std::any_of(known.begin(), known.end(), [&](const auto& each) { return each.name == name; });
  };
  with_usage_errors([&] {
    colormap(session.settings.colormap);
    if (session.settings.vectors.starts_with('@')) choose_vectors({}, session.settings.vectors);
    if (!session.settings.time.empty()) parse_time_range(session.settings);
    check_color_range(session.settings);
    if (!session.sample.empty() && !names(samples(), session.sample) && !names(phantoms(), session.sample))
      throw Error(fmt::format("no sample '{}'", session.sample), "", "`nacre sample` lists them");
  });
  with_usage_errors([&] { check_particle_sizes(session.settings.mesh); });
  check_picture_options(session.settings);
  if (compares(session)) with_usage_errors([&] { check_names(compared_session(session)); });
}

/// Unknown names are found before the work begins, also in the events of a script.
void check_all_names(Session session) {
  check_names(session);
  for (const SessionEvent& event : session.events) try {
      apply_event(event, session);
      check_names(session);
      if (const auto& picture = event.screenshot)
        check_picture_size(session.settings.width * picture->scale, session.settings.height * picture->scale, true,
                           false);
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("the event at {:g} s: {}", event.time, error.what()));
    }
}

/// Offscreen, the panel is drawn only for those who ask for it; a script says for itself whether it shows it.
bool begins_with_panel(const ViewOptions& options, const KnobOptions& knobs, const ViewSettings& view) {
  if (knobs.given("panel", options.common.set)) return view.panel;
  return !options.script.empty() ? view.panel : !options.offscreen;
}

/// --record: a file by its extension, else a folder of pictures.
bool is_frame_folder(const std::filesystem::path& record) {
  return !record.empty() && (record.extension().empty() || std::filesystem::is_directory(record));
}

std::unique_ptr<FrameSink> make_record(const ViewOptions& options, int fps) {
  if (options.record.empty()) return nullptr;
  if (!is_frame_folder(options.record)) return make_video(options.record, fps, &interrupt_flag());
  return make_frame_folder(options.record, [&](const std::string& line) { say(options.common, line); });
}

/// Checks the session against its outputs: the sizes of pictures and video, and the formats of video and result.
void check_view_outputs(const ViewOptions& options, const Session& session) {
  const Settings& settings = session.settings;
  const bool folder = is_frame_folder(options.record), video = !options.record.empty() && !folder;
  check_picture_size(settings.width, settings.height, folder || !options.image.empty(), video);
  with_usage_errors([&] {
    if (video) check_video_name(options.record);
    if (!options.out.empty()) require_format(result_formats(session), options.out);
  });
}

/// How something that the viewer shows came about. A mesh is that of the command, so that it can be made again.
std::string view_origin(const Session& shown, const std::string& output, const std::string& backend) {
  const bool mesh = output == "out" && is_mesh_input(shown);
  Session session = shown;
  if (mesh) session.camera.reset();
  Origin origin = origin_of(session, mesh ? "mesh" : "view", backend, named_files(session.inputs));
  origin.output = output;
  return origin_text(origin);
}

/// Frames that are counted and wait for the computation can be made again.
std::string image_origin(const ViewOptions& options, const ViewerOptions& viewer, const ViewerResult& result) {
  if (!options.offscreen || options.live || !options.script.empty())
    return view_origin(result.shown, "screenshot", result.backend);
  Origin origin = origin_of(viewer.session, "view", result.backend, named_files(viewer.session.inputs));
  origin.options = {"--offscreen"};
  if (viewer.frames > 0) origin.options.push_back(fmt::format("--frames-count={}", viewer.frames));
  origin.output = "image";
  return origin_text(origin);
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
          {"filmed_frames", result.filmed_frames},
          {"steps", result.steps},
          {"copied_bytes", result.copied_bytes},
          {"opengl", {{"renderer", result.renderer}, {"version", result.version}}},
          {"driver_messages", result.driver_messages}};
}

nlohmann::json input_report(const SessionInput& input) {
  if (!input.sample.empty()) return {{"sample", input.sample}, {"detail", input.detail}};
  nlohmann::json files = nlohmann::json::array();
  for (const std::filesystem::path& file : input.inputs) files.push_back(file.string());
  return {{"files", files}};
}

nlohmann::json view_report(const ViewerResult& result, const Session& session) {
  nlohmann::json report = nlohmann::json::object();
  report["nacre"] = version;
  report["command"] = "view";
  report["device"] = {{"backend", result.backend}, {"name", result.device_name}, {"threads", result.threads}};
  report["input"] = input_report(session);
  report["stages"] = stages_report(result.timers);
  report["memory"] = {{"peak_bytes", make_cpu_device()->peak_bytes()}, {"device_peak_bytes", result.peak_bytes}};
  report["parameters"] = knob_values(session.settings);
  report["view"] = frame_report(result);
  return report;
}

/// Finishes and lists the files: the last picture, the frames, the result, and those that the session itself has
/// written. `lost_video` receives the reason where the video could not be finished.
std::vector<std::string> write_outputs(const ViewOptions& options, const ViewerOptions& viewer,
                                       const ViewerResult& result, FrameSink* record, std::string& lost_video) {
  std::vector<std::string> outputs;
  for (const std::filesystem::path& file : result.pictures) outputs.push_back(file.string());
  if (record && lost_video.empty()) try {
      record->finish();
      outputs.push_back(options.record);
    } catch (const Error& error) {
      lost_video = error.what();
    }
  if (!options.image.empty()) {
    if (result.image.pixels.empty()) throw Error("no frame was drawn", "", "keep the window open longer");
    write_png(options.image, result.image, image_origin(options, viewer, result));
    outputs.push_back(options.image);
  }
  if (!options.out.empty() && !result.interrupted) outputs.push_back(options.out);
  if (!options.save_recording.empty()) outputs.push_back(options.save_recording);
  return outputs;
}

void run_view(const ViewOptions& options, const KnobOptions& knobs) {
  check_view_options(options);
  ViewerOptions viewer;
  viewer.session = view_session(options, knobs);
  const Settings& settings = viewer.session.settings;
  check_all_names(viewer.session);
  check_view_outputs(options, viewer.session);
  if (!options.common.save_session.empty()) write_text(options.common.save_session, session_text(viewer.session));
  viewer.welcome = !options.offscreen && has_no_input(options);
  std::string backend;  // of the newest device
  const auto open = [&](const CommonOptions& common) {
    std::unique_ptr<Device> device = open_device(common);
    backend = device->backend();
    return device;
  };
  viewer.open_device = [&] { return open(options.common); };
  viewer.open_spare_device = [&] {
    CommonOptions spare = options.common;
    spare.device = "cpu";
    return open(spare);
  };
  viewer.offscreen = options.offscreen;
  viewer.live = options.live;
  viewer.session.settings.view.panel = begins_with_panel(options, knobs, settings.view);
  const bool flow = !is_mesh_input(viewer.session);  // a mesh is done when it is done
  const bool by_steps = options.offscreen && options.script.empty() && options.frames == 0 && flow;
  viewer.frames = by_steps ? std::max(1, settings.flow.steps) : options.frames;
  viewer.picture = !options.image.empty();
  const std::unique_ptr<FrameSink> record = make_record(options, settings.fps);
  viewer.video = record.get();
  viewer.out = options.out;
  if (!options.save_recording.empty())
    viewer.recorded = [&](const Session& done) { write_text(options.save_recording, session_text(done)); };
  viewer.origin = [&](const Session& shown, const std::string& output) { return view_origin(shown, output, backend); };
  viewer.stop = &interrupt_flag();
  viewer.first_camera = [](const Settings& s, const std::vector<Vec3d>& seen, bool legend) {
    return read_camera(s, seen, legend);
  };
  viewer.check = [](const Session& session) {
    try {
      check_all_names(session);
    } catch (const UsageError& error) {
      throw Error(error.what());
    }
  };
  viewer.say = [&](const std::string& line) { say(options.common, line); };
  const ViewerResult result = run_viewer(viewer);

  std::string lost_video = result.lost_video;
  if (result.interrupted && record) lost_video = options.record + " was not finished";
  const std::vector<std::string> outputs = write_outputs(options, viewer, result, record.get(), lost_video);
  write_report(options.common, view_report(result, viewer.session), outputs);
  print_outputs(outputs);
  if (result.interrupted) throw Interrupted();
  if (!lost_video.empty()) throw Error(lost_video);
}

#else

void run_view(const ViewOptions&, const KnobOptions&) {
  throw Error("this build has no viewer", "its libraries were not found, or it was switched off",
              "run ./dev setup and build again, or use nacre flow and nacre mesh");
}

#endif

}  // namespace

void add_view_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand(
      "view", "the desktop viewer; without a FILE it opens a sample. Flow starts at a resolution of 512");
  auto options = std::make_shared<ViewOptions>();
  add_input_options(*command, options->input,
                    "surface with vectors, or a volume; several files form a time series, or hold one material each",
                    "triangle edges, or voxels, along the sample's longest side (0: its own)");
  command->add_flag("--offscreen", options->offscreen, "draw without a display (EGL)");
  command->add_option("--script", options->script,
                      "play a recorded session: inputs, knobs and camera, each at its time");
  command->add_option("--record", options->record,
                      "write every frame: a video (.mp4, .mkv, .mov, .webm, .gif) or a folder");
  command->add_option("--save-recording", options->save_recording,
                      "record what is done, and when, to a session file for --script");
  command->add_option("--image", options->image, "write the last frame as PNG");
  command->add_option("--preset", options->preset, "source: the constants of the thesis, for volumes")
      ->check(CLI::IsMember({"source"}));
  command->add_option("--out", options->out, "write the result at the end, as nacre flow and nacre mesh do");
  command
      ->add_option("--frames-count", options->frames,
                   "stop after N frames with a texture (offscreen without a script: one frame per step)")
      ->check(CLI::Range(0, 1000000000));
  command->add_flag("--live", options->live,
                    "offscreen: do not wait for the computation between frames, as in a window");
  add_common_options(*command, options->common);
  add_save_session(*command, options->common);
  auto knob_options = std::make_shared<KnobOptions>(*command, "view");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_view(*options, *knob_options); }; });
}

}  // namespace nacre
