// Nacre: `nacre view`: the words of the viewer. OpenGL begins in app/viewer, which a headless build leaves out.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/mesh_run.hpp"
#include "app/picture_words.hpp"
#include "app/run.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/png.hpp"
#include "engine/picture/video.hpp"
#include "engine/scene/knobs.hpp"
#include "engine/scene/phantoms.hpp"
#include "engine/scene/prepare.hpp"
#include "engine/scene/ranges.hpp"
#include "engine/scene/samples.hpp"
#if NACRE_HAS_VIEWER
#include "app/viewer/scene/scene.hpp"
#include "app/viewer/scene/view_defaults.hpp"
#include "app/viewer/window/viewer.hpp"
#endif

namespace nacre {
namespace {

struct ViewOptions {
  CommonOptions common;
  InputWords input;
  std::string script, image, record, save_recording, out, preset;
  int frames = 0;
  bool offscreen = false, live = false, panel = false, no_panel = false;
};

#if NACRE_HAS_VIEWER

constexpr const char* welcome_sample = "torus";
constexpr int welcome_detail = 128;  // reads in a moment

bool is_scalar_phantom(const std::string& name) {
  const std::vector<PhantomInfo> all = phantoms();
  return std::any_of(all.begin(), all.end(), [&](const PhantomInfo& p) { return p.name == name && !p.labelled; });
}

/// As `nacre mesh` does, which knows the volume by then: here an iso-value says that it is a scalar one.
void choose_source_kernel(const CommonOptions& common, const KnobOptions& knobs, Session& session) {
  if (!is_mesh_input(session)) throw UsageError("--preset source is for volumes: its constants are those of meshing");
  if (knobs.given("kernel", common.set)) return;
  const bool scalar = !session.settings.materials.isovalue.empty() || is_scalar_phantom(session.sample);
  session.settings.mesh.kernel = scalar ? "b-spline" : "catmull-rom";
}

/// A session is the state that it begins with; a script is played.
Session view_session(const ViewOptions& options, const KnobOptions& knobs) {
  CommonOptions common = options.common;
  if (!options.script.empty()) common.session = options.script;
  InputWords words = options.input;
  if (words.files.empty() && words.sample.empty() && common.session.empty()) {
    words.sample = welcome_sample;
    if (words.detail == 0) words.detail = welcome_detail;
  }
  const bool own_resolution = !common.session.empty() || knobs.given("resolution", common.set);
  Session session = asked_session(common, words, knobs, "view", [&](Settings& settings) {
    if (!own_resolution) settings.flow.resolution = view_defaults().flow.resolution;
    if (options.preset == "source") apply_source_preset(settings);
  });
  if (options.preset == "source") choose_source_kernel(options.common, knobs, session);
  if (options.script.empty()) return session;
  const Session script = read_session(options.script);
  if (script.events.empty() && script.duration == 0)
    throw Error(options.script + " has nothing to play", "it has neither events nor a duration",
                "give it to --session, or write events into it");
  session.events = script.events;
  session.duration = script.duration;
  return session;
}

void check_view_words(const ViewOptions& options) {
  const bool does = options.frames > 0 || !options.image.empty() || !options.script.empty() ||
                    !options.record.empty() || !options.save_recording.empty() || !options.out.empty();
  if (options.offscreen && !does)
    throw UsageError(
        "--offscreen has nothing to do: give --script, --record, --image FILE.png, --out FILE or --frames-count N");
  if (options.live && !options.offscreen) throw UsageError("--live goes with --offscreen: a window never waits");
  if (options.live && !options.record.empty())
    throw UsageError("--live or --record: frames of a video wait for compute");
  if (!options.script.empty() && !options.common.session.empty())
    throw UsageError("--session or --script, not both: a script has inputs, knobs and camera, too");
  check_output(options.image, "--image", ".png");
  check_output(options.out, "--out", "");
  check_output(options.save_recording, "--save-recording", "");
  check_output(options.common.save_session, "--save-session", "");
  check_output(options.common.report, "--report", "");
  if (options.panel && options.no_panel) throw UsageError("--panel or --no-panel, not both");
}

void check_names(const Session& session) {
  const auto names = [](const auto& known, const std::string& name) {
    return std::any_of(known.begin(), known.end(), [&](const auto& each) { return each.name == name; });
  };
  checked_words([&] {
    colormap(session.settings.colormap);
    if (session.settings.vectors.starts_with('@')) choose_vectors({}, session.settings.vectors);
    if (!session.settings.time.empty()) time_words(session.settings);
    if (!session.settings.color_range.empty()) color_words(session.settings);
    if (!session.sample.empty() && !names(samples(), session.sample) && !names(phantoms(), session.sample))
      throw Error(fmt::format("no sample '{}'", session.sample), "", "`nacre sample` lists them");
  });
  check_particle_sizes(session.settings.mesh);
  check_picture_words(session.settings);
}

/// What names mean is found before the work begins, also for the events of a script.
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

/// A panel offscreen is for those who ask for it; a script says itself.
bool begins_with_panel(const ViewOptions& options, const Look& look) {
  if (options.panel || options.no_panel) return options.panel;
  return !options.script.empty() ? look.panel : !options.offscreen;
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

/// What the session has to fit to: the sizes of the pictures and the film, and the formats of that and the result.
void check_view_outputs(const ViewOptions& options, const Session& session) {
  const Settings& settings = session.settings;
  const bool folder = is_frame_folder(options.record), video = !options.record.empty() && !folder;
  check_picture_size(settings.width, settings.height, folder || !options.image.empty(), video);
  checked_words([&] {
    if (video) check_video_name(options.record);
    if (!options.out.empty()) require_format(result_formats(session), options.out);
  });
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
  nlohmann::json report;
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

/// The last picture, the frames, the result, and what the session itself has written. `lost_video`: is told why there
/// is none.
std::vector<std::string> write_outputs(const ViewOptions& options, const ViewerResult& result, FrameSink* record,
                                       std::string& lost_video) {
  std::vector<std::string> outputs;
  for (const std::filesystem::path& file : result.pictures) outputs.push_back(file.string());
  if (record && lost_video.empty()) try {
      record->finish();
      outputs.push_back(options.record);
    } catch (const Error& error) {
      lost_video = error.what();
    }
  if (!options.image.empty()) {
    if (result.image.pixels.empty()) throw Error("no frame was drawn", "", "keep the window open for longer");
    write_png(options.image, result.image);
    outputs.push_back(options.image);
  }
  if (!options.out.empty() && !result.interrupted) outputs.push_back(options.out);
  if (!options.save_recording.empty()) outputs.push_back(options.save_recording);
  return outputs;
}

void run_view(const ViewOptions& options, const KnobOptions& knobs) {
  check_view_words(options);
  ViewerOptions viewer;
  viewer.session = view_session(options, knobs);
  const Settings& settings = viewer.session.settings;
  check_all_names(viewer.session);
  check_view_outputs(options, viewer.session);
  if (!options.common.save_session.empty()) write_text(options.common.save_session, session_text(viewer.session));
  viewer.open_device = [&] { return open_device(options.common); };
  viewer.open_spare_device = [&] {
    CommonOptions spare = options.common;
    spare.device = "cpu";
    return open_device(spare);
  };
  viewer.offscreen = options.offscreen;
  viewer.live = options.live;
  viewer.session.settings.look.panel = begins_with_panel(options, settings.look);
  const bool flow = !is_mesh_input(viewer.session);  // a mesh is done when it is done
  const bool by_steps = options.offscreen && options.script.empty() && options.frames == 0 && flow;
  viewer.frames = by_steps ? std::max(1, settings.flow.steps) : options.frames;
  viewer.picture = !options.image.empty();
  const std::unique_ptr<FrameSink> record = make_record(options, settings.fps);
  viewer.video = record.get();
  viewer.out = options.out;
  if (!options.save_recording.empty())
    viewer.recorded = [&](const Session& done) { write_text(options.save_recording, session_text(done)); };
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
  const std::vector<std::string> outputs = write_outputs(options, result, record.get(), lost_video);
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
      "view", "the desktop viewer; without a FILE it shows a sample. Flow begins at a resolution of 512");
  auto options = std::make_shared<ViewOptions>();
  add_input_options(*command, options->input,
                    "surface with vectors, or a volume; several files are one series, or a volume's materials",
                    "triangle edges, or voxels, along the sample's longest side (0: its own)");
  command->add_flag("--offscreen", options->offscreen, "draw without a display (EGL)");
  command->add_option("--script", options->script,
                      "play a session file: its input, knobs and camera, each at its time");
  command->add_option("--record", options->record,
                      "write every frame: a video (.mp4, .mkv, .mov, .webm, .gif) or a folder");
  command->add_option("--save-recording", options->save_recording,
                      "write what was done, and when, to a session file for --script");
  command->add_option("--image", options->image, "write the last frame as PNG");
  command->add_option("--preset", options->preset, "source: of a volume, the constants of the dissertation")
      ->check(CLI::IsMember({"source"}));
  command->add_option("--out", options->out, "write the result at the end, as nacre flow and nacre mesh do");
  command
      ->add_option("--frames-count", options->frames,
                   "end after N frames with the texture (offscreen, without a script: one for each step)")
      ->check(CLI::Range(0, 1000000000));
  command->add_flag("--live", options->live, "offscreen: frames do not wait for compute, as in a window");
  command->add_flag("--panel", options->panel, "offscreen: draw the panel, too");
  command->add_flag("--no-panel", options->no_panel, "begin without the panel");
  add_common_options(*command, options->common);
  add_save_session(*command, options->common);
  auto knob_options = std::make_shared<KnobOptions>(*command, "view");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_view(*options, *knob_options); }; });
}

}  // namespace nacre
