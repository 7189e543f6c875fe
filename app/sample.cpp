// Nacre: `nacre sample`: the built-in data sets, listed or written to a file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/commands.hpp"
#include "app/run.hpp"
#include "compute/device/error.hpp"
#include "engine/io/nrrd_writer.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

using Files = std::vector<std::string>;

struct SampleOptions {
  CommonOptions common;
  std::string name, out;
  int detail = 0;
};

nlohmann::json samples_json() {
  nlohmann::json list = nlohmann::json::array();
  for (const SampleInfo& sample : samples())
    list.push_back({{"name", sample.name}, {"kind", "surface"}, {"help", sample.help}});
  for (const PhantomInfo& phantom : phantoms())
    list.push_back({{"name", phantom.name}, {"kind", "volume"}, {"help", phantom.help}});
  return list;
}

void list_samples() {
  fmt::print("surfaces with a flow, for nacre flow:\n");
  for (const SampleInfo& sample : samples()) fmt::print("{:<16} {}\n", sample.name, sample.help);
  fmt::print("\nvolumes, for nacre mesh:\n");
  for (const PhantomInfo& phantom : phantoms())
    fmt::print("{:<16} {} ({} x {} x {})\n", phantom.name, phantom.help, phantom.dims.x, phantom.dims.y,
               phantom.dims.z);
}

/// For a check before the work begins. An unknown name is reported later, with the list of names.
void check_surface_output(const SampleOptions& options) {
  const std::vector<SampleInfo> all = samples();
  if (std::none_of(all.begin(), all.end(), [&](const SampleInfo& s) { return s.name == options.name; })) return;
  Files formats = surface_writer_extensions();
  formats.push_back(".pvd");
  if (std::find(formats.begin(), formats.end(), lower_extension(options.out)) == formats.end())
    throw UsageError(fmt::format("cannot write {}; use one of {}", options.out, fmt::join(formats, " ")));
  check_output(options.out, "--out", "");
}

/// Returns the files, that of the series last.
Files write_surface_sample(const SampleOptions& options) {
  check_surface_output(options);
  const SurfaceSeries series = with_usage_errors([&] { return make_sample(options.name, options.detail); });
  Files files;
  if (lower_extension(options.out) == ".pvd")
    for (const std::filesystem::path& file : write_series(options.out, series)) files.push_back(file.string());
  else
    write_surface(options.out, series.load(0), series.times[0]), files.push_back(options.out);
  return files;
}

/// The sample that was asked for: by its name, else that of the session.
SampleOptions requested_sample(SampleOptions options) {
  if (!options.name.empty() || options.common.session.empty()) return options;
  const Session session = read_session(options.common.session);
  if (session.sample.empty()) throw UsageError(options.common.session + " has no sample; its input is a file");
  options.name = session.sample;
  if (options.detail == 0) options.detail = session.detail;
  return options;
}

Files write_sample(const SampleOptions& options) {
  if (!is_phantom(options.name)) return write_surface_sample(options);
  check_output(options.out, "--out", ".nrrd");
  write_nrrd(options.out,
             with_usage_errors([&] { return make_phantom(options.name, options.detail, &interrupt_flag()); }));
  return {options.out};
}

void report_on(const SampleOptions& options, const StageTimers& timers, const Files& files) {
  if (options.common.report.empty()) return;
  nlohmann::json report = report_frame("sample", *make_cpu_device(options.common.threads), timers, 0);
  if (options.name.empty())
    report["samples"] = samples_json();
  else
    report["input"] = {{"sample", options.name}, {"detail", options.detail}};
  write_report(options.common, std::move(report), files);
}

/// Knobs have no effect here (samples use no random numbers), but they are checked: all commands take the same options.
void run_sample(const SampleOptions& given, const KnobOptions& knob_options) {
  Settings settings;
  knob_options.apply(settings, given.common.set);
  check_output(given.common.report, "--report", "");
  limit_threads(given.common.threads);
  const SampleOptions options = requested_sample(given);
  if (options.name.empty() != options.out.empty())
    throw UsageError(options.name.empty() ? "name a sample; `nacre sample` lists them" : "add --out FILE");
  StageTimers timers;
  Files files;
  if (options.name.empty()) {
    list_samples();
  } else {
    StageTimers::Scope scope(timers, "write");
    files = write_sample(options);
  }
  report_on(options, timers, files);
  if (files.size() > 1)
    fmt::print("{} ({} steps)\n", options.out, files.size() - 1);
  else
    print_outputs(files);
}

}  // namespace

void add_sample_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("sample", "list the built-in data sets, or write one to a file");
  auto options = std::make_shared<SampleOptions>();
  command->add_option("NAME", options->name, "sample to write");
  command->add_option("--out", options->out,
                      "a surface: .pvd (all time steps), or .vtp .ply .obj .stl .off (the first); a volume: .nrrd");
  command
      ->add_option("--detail", options->detail,
                   "triangle edges, or voxels, along the longest side (0: the sample's own)")
      ->check(CLI::Range(0, 1 << 20));
  add_common_options(*command, options->common,
                     {"--report", "write a JSON report to this file", "write the sample of a session file"});
  auto knob_options = std::make_shared<KnobOptions>(*command, "sample");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_sample(*options, *knob_options); }; });
}

}  // namespace nacre
