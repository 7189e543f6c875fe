// Nacre: `nacre info`: what is in a file.
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/common.hpp"
#include "engine/io/reader.hpp"

namespace nacre {
namespace {

nlohmann::json as_json(const FileInfo& info) {
  nlohmann::json arrays = nlohmann::json::array();
  for (const ArrayInfo& a : info.arrays)
    arrays.push_back({{"name", a.name},
                      {"components", a.components},
                      {"on", a.on},
                      {"count", a.count},
                      {"min", a.min},
                      {"max", a.max}});
  const auto vec = [](const Vec3d& v) { return nlohmann::json::array({v.x, v.y, v.z}); };
  return {{"path", info.path},           {"format", info.format},    {"kind", info.kind},
          {"bytes", info.bytes},         {"points", info.points},    {"polygons", info.polygons},
          {"triangles", info.triangles}, {"lower", vec(info.lower)}, {"upper", vec(info.upper)},
          {"times", info.times},         {"arrays", arrays},         {"warnings", info.warnings}};
}

void print(const FileInfo& info) {
  fmt::print("{}\n  {} {}, {} bytes\n", info.path, info.format, info.kind, info.bytes);
  fmt::print("  {} points, {} polygons, {} triangles\n", info.points, info.polygons, info.triangles);
  fmt::print("  box {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}\n", info.lower.x, info.lower.y, info.lower.z,
             info.upper.x, info.upper.y, info.upper.z);
  if (!info.times.empty())
    fmt::print("  {} time step{}, {:g} to {:g}\n", info.times.size(), info.times.size() == 1 ? "" : "s",
               info.times.front(), info.times.back());
  for (const ArrayInfo& a : info.arrays)
    fmt::print("  {:<24} {} component{} on {:<6} {:>9} {}: {:.6g} to {:.6g}\n", a.name, a.components,
               a.components == 1 ? "" : "s", a.on, a.count, a.components > 1 ? "magnitude" : "range", a.min, a.max);
  for (const std::string& warning : info.warnings) fmt::print("  warning: {}\n", warning);
}

}  // namespace

void add_info_command(CLI::App& program, std::function<void()>& run) {
  CLI::App* command = program.add_subcommand("info", "what is in a file: kind, size, arrays, time steps");
  auto files = std::make_shared<std::vector<std::string>>();
  auto json = std::make_shared<bool>(false);
  command->add_option("FILE", *files, "files to look at")->required();
  command->add_flag("--json", *json, "as JSON");
  command->callback([&run, files, json] {
    run = [files, json] {
      for (const std::string& file : *files) {
        const FileInfo info = describe(file);
        if (*json)
          fmt::print("{}\n", as_json(info).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
        else
          print(info);
      }
    };
  });
}

}  // namespace nacre
