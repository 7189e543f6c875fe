// Nacre: `nacre bench`: the thesis's tables on this machine: options, report, comparison.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>

#include "app/bench/against.hpp"
#include "app/bench/bench.hpp"
#include "app/bench/figures.hpp"
#include "app/commands.hpp"
#include "app/parameter_names.hpp"
#include "app/run.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

using nlohmann::json;

struct BenchOptions {
  CommonOptions common;
  std::vector<std::string> tables;
  bool small = false, tiny = false;

  BenchScale scale() const { return tiny ? BenchScale::tiny : small ? BenchScale::small : BenchScale::whole; }
  std::string plots, against;
};

/// Knobs that differ from their defaults, by name.
using ChangedKnobs = std::map<std::string, std::string>;

bool is_requested(const BenchOptions& options, const std::string& name) {
  return options.tables.empty() ||
         std::find(options.tables.begin(), options.tables.end(), name) != options.tables.end();
}

void check_options(const BenchOptions& options) {
  for (const std::string& name : options.tables) {
    const auto& parts = bench_parts();
    if (std::any_of(parts.begin(), parts.end(), [&](const BenchPart& part) { return part.name == name; })) continue;
    std::string known;
    for (const BenchPart& part : parts) known += (known.empty() ? "" : " ") + part.name;
    throw UsageError(fmt::format("there is no table '{}'; choose from {}", name, known));
  }
}

/// Checks outputs before hours of work rather than after.
void check_outputs(const BenchOptions& options) {
  check_output(options.common.report, "--json", "");
  if (options.plots.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(options.plots, error);
  if (!std::filesystem::is_directory(options.plots))
    throw Error("cannot make the folder " + options.plots, error.message(), "give another --plots");
}

/// Of the session, --seed and --set. Input and camera of a session have no meaning here.
ChangedKnobs changed_knobs(const BenchOptions& options, const KnobOptions& knob_options) {
  Settings usual, settings;
  if (!options.common.session.empty()) settings = read_session(options.common.session).settings;
  knob_options.apply(settings, options.common.set);
  ChangedKnobs turned;
  const std::vector<Knob> before = knobs(usual), after = knobs(settings);
  for (std::size_t k = 0; k < after.size(); ++k)
    if (after[k].text() != before[k].text()) turned[after[k].name] = after[k].text();
  return turned;
}

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

json make_report(const BenchOptions& options, const Device& device, const ChangedKnobs& turned) {
  json report = report_frame("bench", device, StageTimers(), 0);
  report.erase("stages");  // every table has its own
  report["small"] = options.scale() != BenchScale::whole;
  if (options.tiny) report["tiny"] = true;
  report["date"] = today();
  if (!turned.empty()) report["set"] = turned;
  report["tables"] = json::array();
  return report;
}

void print_head(const BenchOptions& options, const Device& device, const ChangedKnobs& turned) {
  std::string text = options.tiny ? ", --tiny" : options.small ? ", --small" : "";
  for (const auto& [name, value] : turned) text += fmt::format(", {} {}", name, value);
  fmt::print("nacre {} on {} ({}), {} thread{}, {}{}\n\n", version, device.name(), device.backend(), device.threads(),
             device.threads() == 1 ? "" : "s", today(), text);
}

void write_figures(Bench& bench, const json& report) {
  for (const auto& [name, text] : bench_figures(report)) {
    const std::filesystem::path file = bench.plots / name;
    write_text(file, text);
    bench.outputs.push_back(file.string());
  }
}

/// Writes plots and JSON of the rows so far.
void write_results(const BenchOptions& options, Bench& bench, const json& report) {
  if (!options.plots.empty()) write_figures(bench, report);
  if (!options.common.report.empty()) bench.outputs.push_back(options.common.report);
  write_report(options.common, report, bench.outputs);
  print_outputs(bench.outputs);
}

/// Runs the tables. What has been measured is kept when one of them ends the command; the report says why.
void measure(const BenchOptions& options, Bench& bench, json& report) {
  const auto add_tables = [&] {
    for (const BenchTable& table : bench.tables()) report["tables"].push_back(table_json(table));
  };
  const auto keep = [&](const std::string& why) {
    add_tables();
    report["ended_early"] = why;
    const auto has_rows = [](const BenchTable& table) { return !table.rows.empty(); };
    if (std::none_of(bench.tables().begin(), bench.tables().end(), has_rows)) return;
    try {
      write_results(options, bench, report);
    } catch (const std::exception& error) {  // beside the first reason, which ends the command
      warn(options.common, with_options(error.what()));
    }
  };
  try {
    for (const BenchPart& part : bench_parts()) {
      if (!is_requested(options, part.name)) continue;
      part.run(bench);
      bench.end();
    }
  } catch (const std::exception& error) {
    keep(with_options(error.what()));
    throw;
  }
  add_tables();
  write_results(options, bench, report);
}

void judge(const BenchOptions& options, const json& now, const json& last) {
  const RunComparison result = compare_runs(now, last, options.tables);
  std::string text;
  if (!result.losses.empty())
    text = fmt::format("{} of {} ratios lost more than {:.0f}% against {}: {}", result.losses.size(), result.compared,
                       100 * tolerated_loss, options.against, fmt::join(result.losses, "; "));
  if (!result.missing.empty())
    text += fmt::format("{}this run has no value where {} has one: {}", text.empty() ? "" : "; ", options.against,
                        fmt::join(result.missing, "; "));
  if (!text.empty()) throw Error(text);
  if (result.compared == 0)
    throw Error("nothing to compare with " + options.against, "no table and row is in both runs");
  fmt::print("{} ratios compared with {}: none lost more than {:.0f}%\n", result.compared, options.against,
             100 * tolerated_loss);
}

json read_last(const BenchOptions& options) {
  if (options.against.empty()) return {};
  json last = read_bench(options.against);
  if (last.contains("ended_early"))
    warn(options.common, options.against + " comes from a run that ended early: only its rows are compared");
  return last;
}

void run_bench(const BenchOptions& options, const KnobOptions& knob_options) {
  check_options(options);
  const ChangedKnobs turned = changed_knobs(options, knob_options);
  check_outputs(options);
  const json last = read_last(options);
  const std::unique_ptr<Device> device = open_device(options.common);
  json report = make_report(options, *device, turned);
  if (!last.is_null()) require_comparable(report, last, options.against);
  Bench bench(*device, options.common, options.scale());
  bench.plots = options.plots;
  bench.meshes.turn = bench.flows.turn = [&](Settings& settings) {
    for (const auto& [name, value] : turned) set_knob(settings, name, value);
  };
  print_head(options, *device, turned);
  measure(options, bench, report);
  if (!last.is_null()) judge(options, report, last);
}

}  // namespace

void add_bench_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("bench", "the tables of the thesis, measured on this machine");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("TABLE", options->tables,
                      "3.1 3.2 3.3 3.4 4.1 4.2 4.3 5.1 6.1 6.2 gathering arena grid-octree methods (all)");
  command->add_flag("--small", options->small, "smaller data: two minutes on two cores");
  command->add_flag("--tiny", options->tiny, "for tests: smaller still, figures mean nothing")->group("");  // not shown
  command->add_option("--plots", options->plots, "write the thesis's plots (SVG) and pictures (PNG) into a folder");
  command->add_option("--against", options->against,
                      "JSON of an earlier run: fail if a ratio between methods has lost 30% or is missing");
  add_common_options(*command, options->common,
                     {"--json,--report", "write the results as JSON, also when the run is interrupted",
                      "take knobs from a session file, except those that a table sets itself"});
  auto knob_options = std::make_shared<KnobOptions>(*command, "bench");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_bench(*options, *knob_options); }; });
}

}  // namespace nacre
