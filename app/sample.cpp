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

struct SampleWords {
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
void check_surface_output(const SampleWords& words) {
  const std::vector<SampleInfo> all = samples();
  if (std::none_of(all.begin(), all.end(), [&](const SampleInfo& s) { return s.name == words.name; })) return;
  Files formats = surface_writer_extensions();
  formats.push_back(".pvd");
  if (std::find(formats.begin(), formats.end(), lower_extension(words.out)) == formats.end())
    throw UsageError(fmt::format("cannot write {}; use one of {}", words.out, fmt::join(formats, " ")));
  check_output(words.out, "--out", "");
}

/// Returns the files, that of the series last.
Files write_surface_sample(const SampleWords& words) {
  check_surface_output(words);
  const SurfaceSeries series = checked_words([&] { return make_sample(words.name, words.detail); });
  Files files;
  if (lower_extension(words.out) == ".pvd")
    for (const std::filesystem::path& file : write_series(words.out, series)) files.push_back(file.string());
  else
    write_surface(words.out, series.load(0), series.times[0]), files.push_back(words.out);
  return files;
}

/// The sample that was asked for: by its name, else that of the session.
SampleWords asked_sample(SampleWords words) {
  if (!words.name.empty() || words.common.session.empty()) return words;
  const Session session = read_session(words.common.session);
  if (session.sample.empty()) throw UsageError(words.common.session + " has no sample; its input is a file");
  words.name = session.sample;
  if (words.detail == 0) words.detail = session.detail;
  return words;
}

Files write_sample(const SampleWords& words) {
  if (!is_phantom(words.name)) return write_surface_sample(words);
  check_output(words.out, "--out", ".nrrd");
  write_nrrd(words.out, checked_words([&] { return make_phantom(words.name, words.detail, &interrupt_flag()); }));
  return {words.out};
}

void report_on(const SampleWords& words, const StageTimers& timers, const Files& files) {
  if (words.common.report.empty()) return;
  nlohmann::json report = report_frame("sample", *make_cpu_device(words.common.threads), timers, 0);
  if (words.name.empty())
    report["samples"] = samples_json();
  else
    report["input"] = {{"sample", words.name}, {"detail", words.detail}};
  write_report(words.common, std::move(report), files);
}

/// Knobs have no effect here (samples use no random numbers), but they are checked: all commands take the same options.
void run_sample(const SampleWords& given, const KnobOptions& knob_options) {
  Settings settings;
  knob_options.apply(settings, given.common.set);
  check_output(given.common.report, "--report", "");
  limit_threads(given.common.threads);
  const SampleWords words = asked_sample(given);
  if (words.name.empty() != words.out.empty())
    throw UsageError(words.name.empty() ? "name a sample; `nacre sample` lists them" : "add --out FILE");
  StageTimers timers;
  Files files;
  if (words.name.empty()) {
    list_samples();
  } else {
    StageTimers::Scope scope(timers, "write");
    files = write_sample(words);
  }
  report_on(words, timers, files);
  if (files.size() > 1)
    fmt::print("{} ({} steps)\n", words.out, files.size() - 1);
  else
    print_outputs(files);
}

}  // namespace

void add_sample_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("sample", "list the built-in data sets, or write one to a file");
  auto words = std::make_shared<SampleWords>();
  command->add_option("NAME", words->name, "sample to write");
  command->add_option("--out", words->out,
                      "a surface: .pvd (all time steps), or .vtp .ply .obj .stl .off (the first); a volume: .nrrd");
  command
      ->add_option("--detail", words->detail, "triangle edges, or voxels, along the longest side (0: the sample's own)")
      ->check(CLI::Range(0, 1 << 20));
  add_common_options(*command, words->common,
                     {"--report", "write a JSON report to this file", "write the sample of a session file"});
  auto knob_options = std::make_shared<KnobOptions>(*command, "sample");
  command->callback(
      [&run, words, knob_options] { run = [words, knob_options] { run_sample(*words, *knob_options); }; });
}

}  // namespace nacre
