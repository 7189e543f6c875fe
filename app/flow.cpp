// Nacre: `nacre flow`: unsteady flow on a surface as picture, frames, video, values.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/checkpoint.hpp"
#include "app/commands.hpp"
#include "app/flow_results.hpp"
#include "app/picture_options.hpp"
#include "app/ranks.hpp"
#include "app/run.hpp"
#include "compute/device/error.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/io/named_files.hpp"
#include "engine/io/reader.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/png.hpp"
#include "engine/picture/video.hpp"
#include "engine/run/among_ranks.hpp"
#include "engine/run/dye_run.hpp"
#include "engine/run/flow_maps.hpp"
#include "engine/run/flow_painter.hpp"
#include "engine/run/flow_probes.hpp"
#include "engine/run/flow_report.hpp"
#include "engine/run/focus.hpp"
#include "engine/run/report.hpp"
#include "engine/run/write_values.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/session/session.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/flow_motion.hpp"
#include "engine/scene/surface/haemodynamics.hpp"
#include "engine/scene/surface/surface_share.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

using nlohmann::json;

/// The steps of a run that are made: all of them, or part I of N. Parts differ by one step at most. Throws UsageError.
FrameRange wanted_steps(const std::string& chunk, int steps) {
  if (chunk.empty()) return {0, steps};
  const auto [part, parts] = with_usage_errors([&] { return parse_pair(chunk, '/', "--chunk"); });
  if (part != std::floor(part) || parts != std::floor(parts) || part < 1 || part > parts)
    throw UsageError("--chunk takes I/N with whole numbers, and I from 1 to N, not '" + chunk + "'");
  if (parts > steps)
    throw UsageError(fmt::format("--chunk {} makes more parts than there are steps ({})", chunk, steps));
  const auto begin_of = [steps, parts = parts](double i) { return int(std::int64_t(i) * steps / std::int64_t(parts)); };
  return {begin_of(part - 1), begin_of(part)};
}

/// Finds unknown names and outputs that cannot be written before the work begins.
void check_options(const FlowOptions& options, const Settings& settings) {
  with_usage_errors([&] {
    colormap(settings.colormap);
    if (settings.vectors.starts_with('@')) choose_vectors({}, settings.vectors);
    if (!settings.time.empty()) parse_time_range(settings);
    check_color_range(settings);
    if (!settings.dye.empty()) parse_dyes(settings.dye);
    parse_probes(settings.probe);
  });
  check_picture_options(settings);
  check_picture_size(settings.width, settings.height, !options.image.empty() || !options.frames.empty(),
                     !options.video.empty());
  if (!options.video.empty()) with_usage_errors([&] { check_video_name(options.video); });
  check_output(options.image, "--image", ".png");
  check_output(options.out, "--out", lower_extension(options.out) == ".pvtp" ? ".pvtp" : ".vtp");
  check_output(options.haemodynamics, "--haemodynamics", ".vtp");
  check_output(options.topology_out, "--topology-out", ".vtp");
  check_output(options.streamlines_out, "--streamlines-out", ".vtp");
  check_output(options.ftle_out, "--ftle-out", ".vtp");
  check_output(options.tracks_out, "--tracks-out", ".vtp");
  check_output(options.common.report, "--report", "");
  check_output(options.common.save_session, "--save-session", "");
  check_output(options.checkpoint, "--checkpoint", "");
  if (!options.checkpoint.empty() && !options.video.empty() && options.frames.empty())
    throw UsageError("--checkpoint with --video needs --frames: a video goes on from its frames");
  for (const std::string& output :
       {options.image, options.frames, options.video, options.out, options.haemodynamics, options.topology_out,
        options.streamlines_out, options.ftle_out, options.tracks_out, options.common.report})
    if (!output.empty()) return;
  warn(options.common, "nothing will be written: give --image, --frames, --video, --out or --report");
}

/// Whether what is asked for needs the whole surface in each of several processes.
bool needs_whole_surface(const FlowOptions& options, const Settings& settings) {
  for (const std::string& output : {options.haemodynamics, options.topology_out, options.streamlines_out,
                                    options.ftle_out, options.tracks_out, settings.dye, settings.probe})
    if (!output.empty()) return true;
  return settings.topology || settings.streamlines || settings.tracks || is_ftle(settings.color) ||
         is_haemodynamic(settings.color);
}

/// `ranks`: of a run whose processes have shares of the surface, where that is possible; null: all of it.
VectorsInTime read_input(const FlowOptions& options, const Session& session, StageTimers& timers, Ranks* ranks) {
  StageTimers::Scope scope(timers, "read");
  FlowLog log;
  log.warn = [&](const std::string& sentence) { warn(options.common, sentence); };
  log.note = [&](const std::string& sentence) { say(options.common, sentence); };
  log.chosen = [&](const VectorChoice& choice) {
    say(options.common, fmt::format("vectors: {} ({})", choice.name, choice.reason));
  };
  const auto sample = [&] { return with_usage_errors([&] { return make_sample(session.sample, session.detail); }); };
  if (ranks && !needs_whole_surface(options, session.settings)) {
    SharedSeries shared = session.sample.empty() ? open_surface(session.inputs, session.settings.patch, *ranks)
                                                 : share_series(sample(), *ranks);
    std::string why;
    std::optional<VectorsInTime> input =
        make_flow_input(std::move(shared), *ranks, session.settings, log, why, &interrupt_flag());
    if (input) return std::move(*input);
    say(options.common, "each process has the whole surface: " + why);
  }
  SurfaceSeries series = session.sample.empty() ? open_surface(session.inputs, session.settings.patch) : sample();
  return make_flow_input(std::move(series), session.settings, log, &interrupt_flag());
}

/// What the knob `resolution` leaves to the picture.
int choose_resolution(const FlowOptions& options, const FlowView& view, const VectorsInTime& input,
                      const FlowParameters& parameters, std::size_t available) {
  const int resolution = picture_resolution(view, input, parameters, available);
  if (parameters.resolution == 0)
    say(options.common, fmt::format("resolution: {} cells along the longest side, for a picture of {} x {} pixels",
                                    resolution, view.width, view.height));
  return resolution;
}

/// Whether a close-up is computed on what is in view.
bool may_focus(const FlowOptions& options, const Settings& settings) {
  const bool pictures = !options.image.empty() || !options.frames.empty() || !options.video.empty();
  if (!settings.focus || !pictures || settings.orbit != 0) return false;
  return settings.flow.method != EmbeddingKind::octree || settings.flow.octree != OctreeKind::thesis;
}

/// What a close-up is computed on; none: the whole surface.
std::optional<Focus> choose_focus(const FlowOptions& options, const Settings& settings, const FlowView& view,
                                  const PreparedSurface& surface, bool moves, std::size_t available) {
  std::optional<Focus> focus = focus_on(view, surface, settings.flow, available, picture_budget(view));
  if (!focus) return {};
  if (moves) {
    say(options.common, no_focus_where_it_moves);
    return {};
  }
  if (!options.out.empty()) {
    say(options.common,
        "a close-up, but --out needs the whole surface: the picture has its cells; leave --out away "
        "for a sharper one");
    return {};
  }
  say(options.common, fmt::format("a close-up: {} of {} triangles, {} cells along the part in view, {:.2g} to a pixel "
                                  "(--no-focus: the whole surface)",
                                  focus->part.surface.triangles.size(), surface.triangles.size(), focus->resolution,
                                  focus->pixel / focus->cell_size));
  if (const std::string coarser = coarser_than_pixels(*focus); !coarser.empty()) warn(options.common, coarser);
  return focus;
}

/// Where every frame goes; null if it was not asked for, or another process writes it.
struct Films {
  std::unique_ptr<FrameSink> frames, video;
  bool asked = false;  ///< for frames or a video
  void add(const Image& image) {
    if (frames) frames->add(image);
    if (video) video->add(image);
  }
};

/// `left`: the steps that are made now.
Films open_films(const FlowOptions& options, const FrameRange& left, bool all, int fps, Progress& progress) {
  Films films;
  films.asked = !options.frames.empty() || !options.video.empty();
  if (!is_first_process()) return films;
  const auto tell = [&](const std::string& line) {
    progress.clear();
    say(options.common, line);
  };
  const std::optional<FrameRange> part = all ? std::nullopt : std::optional(left);
  if (!options.frames.empty()) films.frames = make_frame_folder(options.frames, tell, part);
  if (!options.video.empty()) films.video = make_video(options.video, fps, &interrupt_flag());
  return films;
}

/// Null where there is none. Where vectors are steady, it goes as far in a step as the texture.
std::unique_ptr<DyeRun> make_dye(FlowPipeline& pipeline, VectorsInTime& input, const Settings& settings, double start) {
  if (settings.dye.empty()) return {};
  StageTimers::Scope scope(pipeline.timers(), "dye");
  const double step = steady_dye_step(input, settings, pipeline.flow().embedding().cell_size);
  auto dye = std::make_unique<DyeRun>(input, settings, start, step, &interrupt_flag());
  dye->note();
  return dye;
}

/// The dye where it was after steps that are made already: it is carried there again.
void catch_up(DyeRun& dye, FlowPipeline& pipeline, const FrameRange& made) {
  StageTimers::Scope scope(pipeline.timers(), "dye");
  for (int k = made.first; k < made.last; ++k) {
    dye.go_to(pipeline.flow().time_of(k + 1));
    dye.note();
  }
}

/// Returns how long each took, seconds.
std::vector<double> take_steps(FlowPipeline& pipeline, FlowMotion& motion, const FrameRange& steps, DyeRun* dye,
                               FlowPainter& painter, Films& films, Checkpoint& checkpoint, Progress& progress) {
  std::vector<double> seconds;
  for (int k = steps.first; k < steps.last; ++k) {
    const double before = now();
    motion.follow();
    pipeline.flow().step();
    seconds.push_back(now() - before);
    motion.show();
    if (dye) {
      StageTimers::Scope scope(pipeline.timers(), "dye");
      dye->go_to(pipeline.flow().time());
      dye->note();
    }
    if (films.asked) {
      const Image image = painter.paint(k);
      StageTimers::Scope scope(pipeline.timers(), "write");
      films.add(image);
    }
    checkpoint.after_step();
    progress.update("step", double(k + 1 - steps.first) / (steps.last - steps.first));
    if (interrupt_flag()) throw Interrupted();
  }
  return seconds;
}

/// How the run's results come about.
Origin flow_origin(const FlowOptions& options, const Session& session, const std::string& backend) {
  Origin origin = origin_of(session, "flow", backend, named_files(session.inputs));
  if (!options.chunk.empty())
    origin.options = {"--chunk=" + options.chunk, "--lead-in=" + std::to_string(options.lead_in)};
  add_beside(origin, {{"image", options.image},
                      {"video", options.video},
                      {"frames", options.frames},
                      {"out", options.out},
                      {"haemodynamics", options.haemodynamics},
                      {"topology-out", options.topology_out},
                      {"streamlines-out", options.streamlines_out},
                      {"ftle-out", options.ftle_out},
                      {"tracks-out", options.tracks_out}});
  return origin;
}

/// Returns the files. All processes paint, and the first one writes.
std::vector<std::string> write_outputs(const FlowOptions& options, FlowPipeline& pipeline, const FrameRange& steps,
                                       const DyeRun* dye, FlowPainter& painter, Films& films, const Origin& origin) {
  std::vector<std::string> outputs;
  Image image;
  if (!options.image.empty()) image = painter.paint(std::max(0, steps.last - 1));
  StageTimers::Scope scope(pipeline.timers(), "write");
  const bool first = is_first_process();
  if (first && !options.image.empty())
    write_png(options.image, image, origin_of_output(origin, "image")), outputs.push_back(options.image);
  if (films.frames) films.frames->finish(), outputs.push_back(options.frames);
  if (films.video) films.video->finish(), outputs.push_back(options.video);
  if (!options.out.empty()) {
    Origin of_values = origin;
    if (lower_extension(options.out) == ".pvtp") of_values.pieces = run_ranks() ? run_ranks()->count() : 1;
    MoreArrays dyes;
    if (dye) dyes = [dye](std::span<const Vec3d> points) { return dye->at(points); };
    write_values(options.out, pipeline.flow(), run_ranks(), origin_of_output(of_values, "out"), dyes);
    outputs.push_back(options.out);
  }
  return first ? outputs : std::vector<std::string>();
}

void run_flow(FlowOptions options, const KnobOptions& knob_options) {
  options.common = options_of_process(options.common);
  Ranks* ranks = run_ranks();
  Session session = requested_session(options.common, options.input, knob_options, "flow");
  Settings& settings = session.settings;
  if (is_first_process()) check_options(options, settings);
  if (!options.common.save_session.empty()) write_text(options.common.save_session, session_text(session));
  const std::unique_ptr<Device> device = open_device(options.common);
  const std::unique_ptr<FlowPipeline> pipeline = make_flow_pipeline(*device);
  pipeline->watch(&interrupt_flag());
  pipeline->parameters = settings.flow;
  pipeline->ranks = ranks;
  Progress progress(options.common.quiet);
  const FrameRange steps = wanted_steps(options.chunk, remaining_steps(settings));
  Checkpoint checkpoint(options, ranks);
  const FrameRange left = checkpoint.steps_left(steps);
  InputWatch watch(session.inputs);
  const bool whole_film = options.chunk.empty() && left.first == steps.first;
  Films films = open_films(options, left, whole_film, settings.fps, progress);  // complains before what may be long
  if (ranks) require_same_text(*ranks, session_text(session));
  VectorsInTime input = read_input(options, session, pipeline->timers(), ranks);
  const bool pattern = settings.flow.texture != FlowTexture::streaks;
  if (!options.chunk.empty() && pattern)
    throw Error("--chunk needs --texture streaks", "spots and stripes remember all steps before a part");
  if (!options.chunk.empty() && input.moves())
    throw Error("--chunk needs a surface that does not move", "the shape before a part is not known to it");
  if (!options.chunk.empty() && !settings.dye.empty())
    throw Error("--chunk cannot be made with --dye", "where the dye is before a part is not known to it");
  if (ranks && input.moves()) throw Error("a surface that moves needs one process", "", "leave mpirun away");
  const Origin origin = flow_origin(options, session, device->backend());
  for (const OriginFile& each : origin.others) watch.add({each.file});
  checkpoint.require_same(origin);
  if (films.video) films.video->describe(origin_of_output(origin, "video"));
  if (films.frames) repeat_frames(options.frames, {steps.first, left.first}, films.video.get());
  std::vector<std::string> first_outputs;
  if (!options.haemodynamics.empty() && is_first_process()) {
    StageTimers::Scope scope(pipeline->timers(), "write");
    write_haemodynamics(options.haemodynamics, input, origin);
    first_outputs.push_back(options.haemodynamics);
  }
  const PreparedSurface& surface = input.surface();
  const FlowSpan span = flow_span(settings, {input.start(), input.end()});
  if (ranks && !input.share()) require_same_input(*ranks, input, span.start, knob_values(settings).dump());
  const json map_report = make_flow_map(options, pipeline->timers(), input, span, settings, origin, first_outputs);
  FlowPainter painter(*pipeline, input, session,
                      span.frame_time);  // complains about camera and colours before the work
  if (settings.tracks)
    painter.show_tracks(flow_tracks(input, {span.first, span.end}, settings.persistence, &interrupt_flag()));

  const FlowView view{painter.camera(), settings.width, settings.height};
  const std::size_t available = checkpoint.available(first_ones(ranks, device->available_bytes()));
  settings.flow.resolution = choose_resolution(options, view, input, settings.flow, available);
  pipeline->parameters.resolution = settings.flow.resolution;
  std::optional<Focus> focus;
  if (may_focus(options, settings) && !(input.share() && (!options.out.empty() || sees_all(view, input)))) {
    if (input.share()) input = read_input(options, session, pipeline->timers(), nullptr);
    focus = choose_focus(options, settings, view, surface, input.moves(), available);
  }
  const SurfacePart* part = focus ? &focus->part : nullptr;
  if (focus) {
    pipeline->parameters.resolution = focus->resolution;
    painter.show_part(*part);
  }
  const PreparedSurface& shown = part ? part->surface : surface;

  FlowMotion motion(*pipeline, input, [&](const std::string& sentence) {
    progress.clear();
    warn(options.common, sentence);
  });
  progress.update("embed", 0);
  if (part)
    pipeline->embed(flow_mesh(shown));
  else
    motion.embed(span.start);
  const FlowVectors vectors = flow_vectors(input, span.start, span.end, part);
  pipeline->parameters.steps = span.steps;
  pipeline->parameters.first_step = steps.first;
  pipeline->parameters.lead_in = options.lead_in;
  progress.update("warm-up", 0.02);
  const std::unique_ptr<DyeRun> dye = make_dye(*pipeline, input, settings, span.start);
  checkpoint.start(*pipeline, motion, vectors);
  if (dye) {
    catch_up(*dye, *pipeline, {steps.first, left.first});
    painter.show_dye(*dye);
  }
  const std::vector<double> seconds =
      take_steps(*pipeline, motion, left, dye.get(), painter, films, checkpoint, progress);
  checkpoint.end_steps();
  watch.check();
  std::vector<std::string> outputs = write_outputs(options, *pipeline, steps, dye.get(), painter, films, origin);
  outputs.insert(outputs.begin(), first_outputs.begin(), first_outputs.end());
  const json lines =
      is_first_process() ? write_lines(options, *pipeline, input, span, settings, origin, outputs) : json::object();
  progress.clear();
  if (!options.common.report.empty()) {
    json report = report_frame("flow", *device, pipeline->timers(), pipeline->peak_bytes());
    add_flow_report(report, input, vectors, settings, pipeline->flow().embedding(), seconds, focus ? &*focus : nullptr,
                    steps.first);
    if (!options.checkpoint.empty()) report["checkpoint"] = checkpoint.report();
    if (ranks) report["processes"] = ranks_report(*ranks, pipeline->flow().embedding(), report, seconds, input.share());
    report.update(lines);
    report.update(map_report);
    if (dye) report["dye"] = dye->report();
    if (!settings.probe.empty())
      report["probes"] = probes_report(flow_probes(input, settings.probe, &interrupt_flag()), input.color());
    if (input.moves()) report["motion"] = {{"groups", input.series().motion->groups}, {"rebuilds", motion.rebuilds()}};
    if (is_first_process()) write_report(options.common, std::move(report), outputs, origin);
  }
  checkpoint.remove();
  print_outputs(outputs);
}

}  // namespace

void add_flow_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("flow", "unsteady flow on a surface: picture, frames, video, values");
  auto options = std::make_shared<FlowOptions>();
  add_input_options(*command, options->input, "surface with vectors; several files form a time series",
                    "triangle edges along the sample's longest side (0: its own)");
  command->add_option("--image", options->image, "write the last frame as PNG");
  command->add_option("--frames", options->frames, "write every frame into a folder");
  command->add_option("--video", options->video, "write a video: .mp4, .mkv, .mov, .webm or .gif");
  command->add_option("--out", options->out,
                      "write the values as .vtp, one point per surface cell; .pvtp: a file for each process");
  command->add_option("--haemodynamics", options->haemodynamics,
                      "write means of wall shear stress over time as .vtp: TAWSS, OSI, RRT on the points");
  command->add_option("--topology-out", options->topology_out,
                      "write critical points and separatrices of the last frame as .vtp");
  command->add_option("--streamlines-out", options->streamlines_out,
                      "write evenly spaced streamlines of the last frame as .vtp");
  command->add_option("--tracks-out", options->tracks_out,
                      "write the critical points, followed through the steps of the data, as .vtp");
  command->add_option("--ftle-out", options->ftle_out,
                      "write Lyapunov exponents (FTLE) and the flow map over `ftle_time` as .vtp, on the points");
  command->add_option("--chunk", options->chunk,
                      "I/N: only part I of N of the steps, with the frames of the whole run (`nacre join` joins them)");
  command
      ->add_option("--lead-in", options->lead_in,
                   "steps that a part makes from noise before its first, to reach the texture of the whole run")
      ->check(CLI::Range(0, 1000000));
  command->add_option("--checkpoint", options->checkpoint,
                      "keep the state of the run in this file: the same command goes on where it was stopped");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every,
                   "minutes from one checkpoint to the next (0: after each step)")
      ->check(CLI::Range(0.0, 1e6));
  add_common_options(*command, options->common);
  add_save_session(*command, options->common);
  auto knob_options = std::make_shared<KnobOptions>(*command, "flow");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_flow(*options, *knob_options); }; });
}

}  // namespace nacre
