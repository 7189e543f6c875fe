// Nacre: `nacre rerun`: makes a result again from what it says of itself.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <system_error>

#include "app/commands.hpp"
#include "app/run.hpp"
#include "engine/run/origin.hpp"
#include "engine/scene/session/camera_json.hpp"
#include "engine/system/extension.hpp"
#include "engine/system/scratch_folder.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

struct RerunOptions {
  std::string file, out;
  int threads = 0;
  bool quiet = false;
};

/// Whether the origin has only what nacre writes: a file from somewhere else must not make it write other files than
/// the one result.
bool is_harmless(const Origin& origin) {
  static const std::regex option(
      "--(per-material|surface-only|cut-away|chunk=[0-9]+/[0-9]+|lead-in=[0-9]+|offscreen|frames-count=[0-9]+)");
  static const std::regex output(
      "image|video|out|particles-out|haemodynamics|topology-out|streamlines-out|ftle-out|tracks-out|report");
  static const std::regex extension("(\\.[a-z0-9]+)?");
  const auto fits = [](const std::string& text, const std::regex& form) { return std::regex_match(text, form); };
  const bool of_view = origin.command == "view" && origin.output == "image";
  return (origin.command == "flow" || origin.command == "mesh" || origin.command == "join" || of_view) &&
         fits(origin.output, output) &&
         std::all_of(origin.options.begin(), origin.options.end(),
                     [&](const auto& each) { return fits(each, option); }) &&
         std::all_of(origin.beside.begin(), origin.beside.end(), [&](const auto& each) {
           return (fits(each.first, output) || each.first == "frames") && fits(each.second, extension);
         });
}

Origin require_origin(const fs::path& file) {
  std::error_code code;
  if (!fs::is_regular_file(file, code))
    throw Error(file.string() + " cannot be opened", "there is no such file", "check the name");
  const std::optional<Origin> origin = find_origin(file);
  if (!origin)
    throw Error(file.string() + " does not say how it was made",
                "it is not of Nacre, or its format has no place for that",
                "give the report of that run: nacre rerun REPORT.json --out FILE");
  if (!origin->arrays.empty())
    throw Error(file.string() + " cannot be made again", "the library made it of arrays in memory",
                "its version, its knobs and the SHA-256 of the arrays are in the file");
  if (origin->interrupted)
    throw Error(file.string() + " cannot be made again", "Ctrl-C ended its run, and it does not say when");
  const bool in_window = origin->command == "view" && (origin->output != "image" || origin->options.empty());
  if (in_window)
    throw Error(file.string() + " cannot be made again", "it is of a window, or of a script",
                lower_extension(file) == ".png" ? "nacre view --session " + file.string() + " shows it again"
                                                : "its inputs and knobs are in the file");
  if (!is_harmless(*origin))
    throw Error(file.string() + " cannot be made again", "what it says of how it was made is not by nacre");
  return *origin;
}

/// The arguments that make one result, `output`, of that run as the file `target`.
Arguments arguments_for(const Origin& of_run, const std::string& output, const fs::path& target,
                        const ScratchFolder& scratch) {
  const Origin origin = output == "report" ? of_run : origin_alone(of_run, output);
  Arguments arguments = {origin.command};
  for (const OriginFile& input : origin.inputs)
    arguments.push_back((input.file.starts_with('-') ? "./" : "") + input.file);
  for (const OriginFile& folder : origin.frames)
    arguments.push_back((folder.file.starts_with('-') ? "./" : "") + folder.file);
  if (!origin.sample.empty()) arguments.push_back("--sample=" + origin.sample);
  if (origin.detail != 0) arguments.push_back("--detail=" + std::to_string(origin.detail));
  for (const auto& [name, value] : origin.knobs) arguments.push_back("--set=" + name + "=" + value);
  if (origin.command != "join") arguments.push_back("--device=" + origin.backend);
  arguments.insert(arguments.end(), origin.options.begin(), origin.options.end());
  if (origin.camera) {
    const fs::path session = scratch / "camera.json";
    std::ofstream(session) << nlohmann::json{{"camera", camera_json(*origin.camera)}};
    arguments.insert(arguments.end(), {"--session", session.string()});
  }
  arguments.insert(arguments.end(), {"--" + output, target.string()});
  if (output == "report")  // it tells of them
    for (const auto& [other, extension] : origin.beside)
      arguments.insert(arguments.end(), {"--" + other, (scratch / ("beside-" + other + extension)).string()});
  return arguments;
}

/// The result of a report's run that has the extension of `out`: a report can make all of them.
std::string output_for(const Origin& origin, const std::string& out) {
  if (origin.output != "report" || out.empty() || lower_extension(out) == ".json") return origin.output;
  for (const auto& [output, extension] : origin.beside)
    if (extension == lower_extension(out)) return output;
  throw Error("the run had no result " + lower_extension(out), "",
              "give --out a name that ends like one of its results");
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void erase_times(nlohmann::json& part) {
  for (auto item = part.begin(); item != part.end();)
    if (part.is_object() && item.key().starts_with("seconds")) {
      item = part.erase(item);
    } else {
      if (item->is_structured()) erase_times(*item);
      ++item;
    }
}

/// A report without what differs from run to run: times, memory, the device, the names of the results.
std::string lasting_part(const fs::path& file) {
  nlohmann::json report = nlohmann::json::parse(content_of(file));
  for (const char* key : {"stages", "memory", "device", "outputs"}) report.erase(key);
  erase_times(report);
  return report.dump(1, ' ', true, nlohmann::json::error_handler_t::replace);
}

/// The file among those in the folder that is the result again: --per-material writes several.
bool is_among(const fs::path& result, const fs::path& folder, const std::string& stem) {
  const std::string before = content_of(result);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with(stem) && content_of(entry.path()) == before) return true;
  return false;
}

void run_rerun(const RerunOptions& options, const std::function<void(const Arguments&)>& execute) {
  const fs::path file = options.file;
  const Origin origin = require_origin(file);
  check_inputs(origin, file);
  if (origin.pieces > 0 && options.out.empty())
    throw Error(file.string() + " cannot be compared", "it is of the values of several processes, in pieces",
                "give --out FILE.vtp: all of them in one file, by one process");
  CommonOptions common;
  common.quiet = options.quiet;
  if (origin.version != version)
    say(common, fmt::format("made by nacre {}; this is {}, whose results may differ", origin.version, version));
  const fs::path beside = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  const fs::path folders[] = {temporary_folder(), beside};
  const ScratchFolder scratch("nacre-rerun", folders, "cannot make " + file.string() + " again");
  const std::string output = output_for(origin, options.out);
  const fs::path target = options.out.empty() ? scratch / ("again" + lower_extension(file)) : fs::path(options.out);
  Arguments arguments = arguments_for(origin, output, target, scratch);
  arguments.push_back("--quiet");
  if (options.threads > 0) arguments.insert(arguments.end(), {"--threads", std::to_string(options.threads)});
  if (!options.out.empty() && output != "report") return execute(arguments);
  {
    const PrintNothing quiet;
    execute(arguments);
  }
  if (!options.out.empty()) return print_outputs({options.out});
  const bool same =
      output == "report" ? lasting_part(file) == lasting_part(target) : is_among(file, scratch.path(), "again");
  if (!same)
    throw Error("made again, " + file.string() + " is not the same",
                origin.version != version ? "another version of nacre made it"
                                          : "it was changed, or made on a processor that rounds in another way",
                "give --out FILE to see the other one");
  fmt::print("{}: the same\n", file.string());
}

}  // namespace

void add_rerun_command(CLI::App& program, std::function<void()>& run, std::function<void(const Arguments&)> execute) {
  CLI::App* command = program.add_subcommand("rerun", "make a result again from what it says of itself, and compare");
  auto options = std::make_shared<RerunOptions>();
  command
      ->add_option("FILE", options->file, "a picture, video, mesh, values or report of nacre flow, mesh, join or view")
      ->required();
  command->add_option("--out", options->out, "write it to this file instead of comparing it with FILE");
  command->add_option("--threads", options->threads, "worker threads, at most one per processor (0: all)")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", options->quiet, "print only results, warnings about them, and errors");
  command->callback([&run, options, execute] { run = [options, execute] { run_rerun(*options, execute); }; });
}

}  // namespace nacre
