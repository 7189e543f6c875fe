// Nacre: `nacre bench`: the source's tables on this machine.
#include "app/bench/bench.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "app/bench/against.hpp"
#include "app/bench/figures.hpp"
#include "app/commands.hpp"
#include "app/run.hpp"

namespace nacre {
namespace {

struct BenchOptions {
  CommonOptions common;
  std::vector<std::string> tables;
  bool small = false;
  std::string json, plots, against;
};

bool asked_for(const BenchOptions& options, const std::string& name) {
  return options.tables.empty() ||
         std::find(options.tables.begin(), options.tables.end(), name) != options.tables.end();
}

void check_words(const BenchOptions& options) {
  for (const std::string& name : options.tables) {
    const auto& parts = bench_parts();
    if (std::any_of(parts.begin(), parts.end(), [&](const BenchPart& part) { return part.name == name; })) continue;
    std::string known;
    for (const BenchPart& part : parts) known += (known.empty() ? "" : " ") + part.name;
    throw UsageError(fmt::format("there is no table '{}'; choose from {}", name, known));
  }
}

/// What is found out before the hours of work rather than after.
void check_outputs(const BenchOptions& options) {
  check_output(options.json, "--json", "");
  if (options.plots.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(options.plots, error);
  if (!std::filesystem::is_directory(options.plots))
    throw Error("cannot make the folder " + options.plots, error.message(), "give another --plots");
}

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

nlohmann::json make_report(const BenchOptions& options, const Device& device) {
  nlohmann::json report = report_frame("bench", device, StageTimers(), 0);
  report.erase("stages");
  report.erase("memory");
  report["small"] = options.small;
  report["date"] = today();
  report["tables"] = nlohmann::json::array();
  return report;
}

void write_figures(Bench& bench, const nlohmann::json& report) {
  for (const auto& [name, text] : bench_figures(report)) {
    const std::filesystem::path file = bench.plots / name;
    write_text(file, text);
    bench.outputs.push_back(file.string());
  }
}

void judge(const BenchOptions& options, const nlohmann::json& now, const nlohmann::json& last) {
  const Comparison result = compare_runs(now, last);
  for (const std::string& one : result.missing) warn(options.common, "not compared, this run has no figure: " + one);
  if (!result.losses.empty()) {
    std::string text;
    for (const std::string& loss : result.losses) text += (text.empty() ? "" : "; ") + loss;
    throw Error(fmt::format("{} of {} ratios lost more than {:.0f}% against {}: {}", result.losses.size(),
                            result.compared, 100 * tolerated_loss, options.against, text));
  }
  if (result.compared == 0)
    throw Error("nothing to compare with " + options.against, "no table and row is in both runs");
  fmt::print("{} ratios compared with {}: none lost more than {:.0f}%\n", result.compared, options.against,
             100 * tolerated_loss);
}

void run_bench(const BenchOptions& options) {
  check_words(options);
  check_outputs(options);
  const nlohmann::json last = options.against.empty() ? nlohmann::json() : read_bench(options.against);
  const std::unique_ptr<Device> device = open_device(options.common);
  nlohmann::json report = make_report(options, *device);
  if (!last.is_null()) require_comparable(report, last, options.against);
  Bench bench(*device, options.common, options.small);
  bench.plots = options.plots;
  fmt::print("nacre {} on {} ({}), {} thread{}, {}{}\n\n", version, device->name(), device->backend(),
             device->threads(), device->threads() == 1 ? "" : "s", today(), options.small ? ", --small" : "");
  for (const BenchPart& part : bench_parts()) {
    if (!asked_for(options, part.name)) continue;
    const auto before = std::chrono::steady_clock::now();
    const BenchTable table = part.run(bench);
    bench.meshes.release();
    fmt::print("{}", table_text(table));
    std::fflush(stdout);
    report["tables"].push_back(table_json(table));
    report["tables"].back()["seconds"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  }
  if (!options.plots.empty()) write_figures(bench, report);
  if (!options.json.empty()) {
    write_text(options.json, report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    bench.outputs.push_back(options.json);
  }
  print_outputs(bench.outputs);
  if (!last.is_null()) judge(options, report, last);
}

}  // namespace

void Bench::row(BenchTable& table, const std::string& name, const std::string& input,
                const std::function<void()>& work) {
  if (interrupt_flag()) throw Interrupted();
  say(common, fmt::format("bench {}: {}", table.name, name));
  try {
    work();
  } catch (const Error& error) {
    if (std::string(error.what()).find("memory") == std::string::npos) throw;
    leave_out(table, name, input, error.what());
  }
}

void Bench::leave_out(BenchTable& table, const std::string& name, const std::string& input, const std::string& why) {
  warn(common, fmt::format("bench {}: {} is left out: {}", table.name, name, why));
  table.leave_out(name, input, why);
}

const std::vector<BenchPart>& bench_parts() {
  static const std::vector<BenchPart> parts{{"3.1", bench_quality},
                                            {"3.2", bench_solvers},
                                            {"3.3", bench_synthetic},
                                            {"3.4", bench_sizing},
                                            {"gathering", bench_gathering},
                                            {"4.1", bench_material_quality},
                                            {"4.2", bench_material_solvers},
                                            {"4.3", bench_material_stages},
                                            {"5.1", bench_grid_flow},
                                            {"6.1", bench_octree_flow},
                                            {"6.2", bench_neighbour_index},
                                            {"arena", bench_arena},
                                            {"grid-octree", bench_grid_octree},
                                            {"methods", bench_methods}};
  return parts;
}

void add_bench_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("bench", "the source's tables, on this machine");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("TABLE", options->tables,
                      "3.1 3.2 3.3 3.4 4.1 4.2 4.3 5.1 6.1 6.2 gathering arena grid-octree methods (all)");
  command->add_flag("--small", options->small, "smaller data: two minutes on two cores");
  command->add_option("--json,--report", options->json, "write the figures as JSON");
  command->add_option("--plots", options->plots, "write the source's plots (SVG) and pictures (PNG) into a folder");
  command->add_option("--against", options->against,
                      "JSON of an earlier run: fail where a ratio between methods has lost 30%");
  command->add_option("--device", options->common.device, "auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  command->add_option("--threads", options->common.threads, "worker threads (0: all)")->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", options->common.quiet, "nothing but the tables and errors");
  command->callback([&run, options] { run = [options] { run_bench(*options); }; });
}

}  // namespace nacre
