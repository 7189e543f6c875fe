// Nacre: reads formats that only VTK knows, in a child process.
#include "engine/io/vtk_child.hpp"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>

#include "compute/device/error.hpp"
#include "engine/system/child_process.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds time_limit{120};
constexpr std::string_view complaint_prefix =
    "nacre-vtk-import: ";  // begins the one line in which the child reports a failure

std::atomic<const std::atomic<bool>*> watched{nullptr};

fs::path child_path() {
  if (const char* chosen = std::getenv("NACRE_VTK_IMPORT"); chosen && *chosen) return chosen;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path{} : self.parent_path() / "nacre-vtk-import";
}

std::shared_ptr<const fs::path> make_folder(const fs::path& file) {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "nacre-vtk-XXXXXX").string();
  if (error || !::mkdtemp(name.data()))
    throw Error(
        fmt::format("cannot read {}", file.string()),
        fmt::format("no temporary folder: {}", error ? error.message() : std::generic_category().message(errno)),
        "set TMPDIR to a folder that you may write to");
  add_unfinished(name);
  return {new fs::path(name), [](const fs::path* path) {
            std::error_code ignored;
            fs::remove_all(*path, ignored);
            drop_unfinished(*path);
            delete path;
          }};
}

/// VTK quotes from damaged files; nothing of that may move a terminal's cursor.
std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return text;
}

/// The child's own message, without the name of the file; otherwise the first line that anything printed.
std::string complaint_in(const std::string& errors) {
  std::istringstream lines(errors);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(complaint_prefix))
      return printable(line.substr(complaint_prefix.size(), line.find(" for file: ") - complaint_prefix.size()));
    if (first.empty() && line.find_first_not_of(" \t\r") != std::string::npos) first = line;
  }
  return first.empty() ? "VTK could not read it" : printable(first.substr(0, 300));
}

/// What is looked for in a file, and to which format the user can convert it if that fails.
struct Wanted {
  const char* word;
  const char* formats;
  bool volume;
};
constexpr Wanted surfaces{"surface", ".vtp or .vtu", false}, volumes{"volume", ".vti or .nrrd", true};

void check(const ChildResult& result, const Wanted& wanted, const fs::path& file) {
  const std::string what = fmt::format("cannot read {}", file.string());
  if (result.timed_out)
    throw Error(what, fmt::format("VTK did not finish within {} s", time_limit.count()),
                fmt::format("convert it to {} with ParaView", wanted.formats));
  if (result.stopped || result.signal == SIGINT || result.signal == SIGTERM) throw Interrupted();
  if (result.signal != 0)
    throw Error(what, fmt::format("VTK crashed on it (signal {})", result.signal), "the file is probably damaged");
  if (result.exit_status != 0) throw Error(what, complaint_in(result.errors), "check the file with ParaView");
}

/// Adds the step of one line "time path". False if the line is something else.
bool add_step(const std::string& line, VtkConversion& conversion) {
  double time = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), time);
  if (error != std::errc{} || end == line.data() + line.size() || *end != ' ') return false;
  conversion.times.push_back(time);
  conversion.files.emplace_back(std::string(end + 1, line.data() + line.size()));
  return true;
}

VtkConversion convert(const fs::path& file, const Wanted& wanted) {
  if (!vtk_child_available())
    throw Error(fmt::format("cannot read {}", file.string()), "this program was built without VTK",
                fmt::format("convert the file to {}, or build where VTK is installed", wanted.formats));
  VtkConversion conversion;
  conversion.folder = make_folder(file);
  std::vector<std::string> arguments{fs::absolute(file).string(), conversion.folder->string()};
  if (wanted.volume) arguments.insert(arguments.begin(), "--volume");
  const ChildResult result = run_child(child_path(), arguments, time_limit, watched.load());
  check(result, wanted, file);
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) add_step(line, conversion);
  if (conversion.files.empty())
    throw Error(fmt::format("cannot read {}", file.string()), fmt::format("VTK found no {} in it", wanted.word),
                "check the file with ParaView");
  return conversion;
}

}  // namespace

bool vtk_child_available() {
  const fs::path path = child_path();
  return !path.empty() && ::access(path.c_str(), X_OK) == 0;
}

bool vtk_child_reads(const std::string& extension) {
  static constexpr std::array<std::string_view, 14> extensions = {".vtk",  ".vts",  ".vtr",  ".vtm",   ".vtmb",
                                                                  ".pvts", ".pvtr", ".case", ".encas", ".ex2",
                                                                  ".exo",  ".e",    ".g",    ".foam"};
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

void watch_vtk_child(const std::atomic<bool>* stop) { watched = stop; }

VtkConversion convert_with_vtk(const fs::path& file) { return convert(file, surfaces); }

VtkConversion convert_volume_with_vtk(const fs::path& file) { return convert(file, volumes); }

}  // namespace nacre
