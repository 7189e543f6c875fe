// Nacre: `nacre info`: what is in a file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/commands.hpp"
#include "app/run.hpp"
#include "engine/io/reader.hpp"

namespace nacre {
namespace {

constexpr std::size_t shown_labels = 64;

struct InfoOptions {
  CommonOptions common;
  std::vector<std::string> files;
  bool json = false;
};

nlohmann::json vector_as_json(const Vec3d& v) { return {v.x, v.y, v.z}; }

/// Empty where the file does not say.
std::string name_of(const VolumeInfo& volume, std::int64_t label) {
  const auto found = volume.label_names.find(label);
  return found == volume.label_names.end() ? "" : found->second;
}

nlohmann::json as_json(const VolumeInfo& volume) {
  nlohmann::json labels = nlohmann::json::array();
  for (const auto& [label, voxels] : volume.labels)
    labels.push_back({{"label", label}, {"voxels", voxels}, {"name", name_of(volume, label)}});
  nlohmann::json axes = nlohmann::json::array();
  for (const Vec3d& axis : volume.axes) axes.push_back(vector_as_json(axis));
  return {{"dimensions", {volume.dims.x, volume.dims.y, volume.dims.z}},
          {"spacing", vector_as_json(volume.spacing)},
          {"origin", vector_as_json(volume.origin)},
          {"axes", axes},
          {"right_handed", volume.right_handed},
          {"space", volume.space},
          {"type", volume.type},
          {"min", volume.statistics.min},
          {"max", volume.statistics.max},
          {"integral", volume.statistics.integral},
          {"nan", volume.statistics.nan},
          {"infinite", volume.statistics.infinite},
          {"labels", labels}};
}

nlohmann::json as_json(const FileInfo& info) {
  nlohmann::json arrays = nlohmann::json::array();
  for (const ArrayInfo& a : info.arrays)
    arrays.push_back({{"name", a.name},
                      {"components", a.components},
                      {"on", a.on},
                      {"count", a.count},
                      {"min", a.min},
                      {"max", a.max}});
  nlohmann::json json = {{"path", info.path},
                         {"format", info.format},
                         {"kind", info.kind},
                         {"bytes", info.bytes},
                         {"points", info.points},
                         {"polygons", info.polygons},
                         {"triangles", info.triangles},
                         {"lower", vector_as_json(info.lower)},
                         {"upper", vector_as_json(info.upper)},
                         {"times", info.times},
                         {"arrays", arrays},
                         {"parts", info.parts},
                         {"warnings", info.warnings}};
  if (info.volume) json["volume"] = as_json(*info.volume);
  return json;
}

void print(const VolumeInfo& volume) {
  const auto triple = [](const Vec3d& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z); };
  fmt::print("  {} x {} x {} voxels of {}, spacing {}, origin {}\n", volume.dims.x, volume.dims.y, volume.dims.z,
             volume.type, triple(volume.spacing), triple(volume.origin));
  fmt::print("  axes ({}) ({}) ({}), {}-handed{}{}\n", triple(volume.axes[0]), triple(volume.axes[1]),
             triple(volume.axes[2]), volume.right_handed ? "right" : "left", volume.space.empty() ? "" : ", in ",
             volume.space);
  const VolumeStatistics& statistics = volume.statistics;
  fmt::print("  values {:.9g} to {:.9g}{}", statistics.min, statistics.max,
             statistics.integral ? ", all integers" : "");
  if (statistics.nan + statistics.infinite > 0)
    fmt::print(", {} voxels NaN, {} infinite", statistics.nan, statistics.infinite);
  fmt::print("\n");
  if (volume.labels.empty()) return;
  fmt::print("  {} different values\n", volume.labels.size());
  for (std::size_t i = 0; i < std::min(shown_labels, volume.labels.size()); ++i) {
    const auto& [label, voxels] = volume.labels[i];
    const std::string name = name_of(volume, label);
    fmt::print("  {:>12} {:>12} voxels{}{}\n", label, voxels, name.empty() ? "" : "  ", name);
  }
  if (volume.labels.size() > shown_labels) fmt::print("  ... and {} more\n", volume.labels.size() - shown_labels);
}

void print(const FileInfo& info) {
  fmt::print("{}\n  {} {}, {} bytes\n", info.path, info.format, info.kind, info.bytes);
  if (info.volume)
    print(*info.volume);
  else
    fmt::print("  {} points, {} polygons, {} triangles\n", info.points, info.polygons, info.triangles);
  fmt::print("  box {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}\n", info.lower.x, info.lower.y, info.lower.z,
             info.upper.x, info.upper.y, info.upper.z);
  if (!info.times.empty())
    fmt::print("  {} time step{}, {:g} to {:g}\n", info.times.size(), info.times.size() == 1 ? "" : "s",
               info.times.front(), info.times.back());
  for (const ArrayInfo& a : info.arrays)
    fmt::print("  {:<24} {} component{} on {:<6} {:>9} {}: {:.6g} to {:.6g}\n", a.name, a.components,
               a.components == 1 ? "" : "s", a.on, a.count, a.components > 1 ? "magnitude" : "range", a.min, a.max);
  if (!info.parts.empty()) fmt::print("  parts: {}\n", fmt::join(info.parts, ", "));
  for (const std::string& warning : info.warnings) fmt::print("  warning: {}\n", warning);
}

/// The files of the command line, else those of the session.
std::vector<std::string> requested_files(const InfoOptions& options) {
  std::vector<std::string> files = options.files;
  if (files.empty() && !options.common.session.empty())
    for (const std::filesystem::path& file : read_session(options.common.session).inputs)
      files.push_back(file.string());
  if (files.empty()) throw UsageError("no input: give a FILE; see nacre info --help");
  return files;
}

/// Knobs have no effect here but for the names and layers of labels, and for patches; they are checked: all commands
/// take the same options.
void run_info(const InfoOptions& options, const KnobOptions& knob_options) {
  Settings settings;
  knob_options.apply(settings, options.common.set);
  check_output(options.common.report, "--report", "");
  limit_threads(options.common.threads);
  StageTimers timers;
  nlohmann::json files = nlohmann::json::array();
  for (const std::string& file : requested_files(options)) {
    FileInfo info;
    {
      StageTimers::Scope scope(timers, "read");
      info = describe(file, {settings.materials.layer, settings.materials.names}, settings.patch);
    }
    files.push_back(as_json(info));
    if (options.json)
      fmt::print("{}\n", files.back().dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    else
      print(info);
  }
  if (options.common.report.empty()) return;
  nlohmann::json report = report_frame("info", *make_cpu_device(options.common.threads), timers, 0);
  report["input"] = {{"files", std::move(files)}};
  write_report(options.common, std::move(report), {});
}

}  // namespace

void add_info_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("info", "what is in a file: kind, size, arrays, time steps, labels");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("FILE", options->files, "files to describe");
  command->add_flag("--json", options->json, "as JSON");
  add_common_options(*command, options->common,
                     {"--report", "write the same as JSON to this file", "describe the files of a session"});
  auto knob_options = std::make_shared<KnobOptions>(*command, "info");
  command->callback(
      [&run, options, knob_options] { run = [options, knob_options] { run_info(*options, *knob_options); }; });
}

}  // namespace nacre
