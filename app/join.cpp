// Nacre: `nacre join`: the frames that the parts of a run have written, as one video.
#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

#include "app/commands.hpp"
#include "app/run.hpp"
#include "compute/device/stage_timers.hpp"
#include "engine/picture/video.hpp"

namespace nacre {
namespace {

struct JoinOptions {
  CommonOptions common;
  std::string folder, video;
};

void run_join(const JoinOptions& options, const KnobOptions& knob_options) {
  Settings settings;
  knob_options.apply(settings, options.common.set);
  if (options.folder.empty() || options.video.empty())
    throw UsageError("name the folder of frames, and a video: nacre join FOLDER --video FILE");
  with_usage_errors([&] { check_video_name(options.video); });
  check_output(options.common.report, "--report", "");
  limit_threads(options.common.threads);
  Origin origin;
  origin.version = version;
  origin.command = "join";
  origin.backend = "cpu";
  origin.frames = {read_frames(options.folder)};
  origin.knobs["fps"] = std::to_string(settings.fps);
  add_beside(origin, {{"video", options.video}});
  StageTimers timers;
  {
    StageTimers::Scope scope(timers, "write");
    make_video_of_folder(options.folder, options.video, settings.fps, origin_of_output(origin, "video"),
                         &interrupt_flag());
  }
  if (!options.common.report.empty())
    write_report(options.common, report_frame("join", *make_cpu_device(options.common.threads), timers, 0),
                 {options.video}, origin);
  print_outputs({options.video});
}

}  // namespace

void add_join_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("join", "a video of the frames that `nacre flow --chunk` has written");
  auto options = std::make_shared<JoinOptions>();
  command->add_option("FOLDER", options->folder, "frames, as written by --frames; none may be missing");
  command->add_option("--video", options->video, "write a video: .mp4, .mkv, .mov, .webm or .gif");
  add_common_options(*command, options->common,
                     {"--report", "write a JSON report to this file", "not used: frames are as they are"});
  auto knob_options = std::make_shared<KnobOptions>(*command, "join");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_join(*options, *knob_options); }; });
}

}  // namespace nacre
