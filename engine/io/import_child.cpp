// Nacre: formats that libraries of others read, in a child process.
#include "engine/io/import_child.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>

#include "compute/device/error.hpp"
#include "engine/system/child_process.hpp"
#include "engine/system/scratch_folder.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds time_limit{120};

std::atomic<const std::atomic<bool>*> watched{nullptr};

/// Beside this program, or in libexec/nacre, where an installed one has it: from bin/, or from libexec/nacre/LEVEL.
fs::path child_path(const Importer& importer) {
  if (const char* chosen = std::getenv(importer.variable); chosen && *chosen) return chosen;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path beside = self.parent_path() / importer.program;
  const fs::path above = self.parent_path().parent_path();
  for (const fs::path& folder : {self.parent_path(), above / "libexec" / "nacre", above})
    if (fs::exists(folder / importer.program, error)) return folder / importer.program;
  return beside;
}

std::shared_ptr<const fs::path> make_folder(const fs::path& file) {
  const fs::path folders[] = {temporary_folder()};
  const auto folder = std::make_shared<ScratchFolder>("nacre-import", folders, "cannot read " + file.string());
  return {folder, &folder->path()};
}

/// Libraries quote from damaged files; nothing of that may move a terminal's cursor.
std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return text;
}

/// The child's own message, without the name of the file; otherwise the first line that anything printed.
std::string complaint_in(const std::string& errors, const Importer& importer) {
  const std::string prefix = std::string(importer.program) + ": ";
  std::istringstream lines(errors);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(prefix)) {
      const std::string_view text = std::string_view(line).substr(prefix.size());
      return printable(std::string(text.substr(0, text.find(" for file: "))));
    }
    if (first.empty() && line.find_first_not_of(" \t\r") != std::string::npos) first = line;
  }
  return first.empty() ? fmt::format("{} could not read it", importer.library) : printable(first.substr(0, 300));
}

void check(const ChildResult& result, const ImportRequest& request, const Importer& importer) {
  const std::string what = fmt::format("cannot read {}", request.file.string());
  if (result.timed_out)
    throw Error(what, fmt::format("{} did not finish within {} s", importer.library, time_limit.count()),
                fmt::format("convert it to {} with {}", request.formats, importer.other_program));
  if (result.stopped || result.signal == SIGINT || result.signal == SIGTERM) throw Interrupted();
  if (result.signal != 0)
    throw Error(what, fmt::format("{} crashed on it (signal {})", importer.library, result.signal),
                "the file is probably damaged");
  if (result.exit_status != 0)
    throw Error(what, complaint_in(result.errors, importer),
                fmt::format("check the file with {}", importer.other_program));
}

/// Adds what one line tells, "time path" or "part name"; other lines are nothing.
void add_line(const std::string& line, ImportResult& imported) {
  constexpr std::string_view part = "part ";
  if (line.starts_with(part)) {
    imported.parts.push_back(printable(line.substr(part.size())));
    return;
  }
  double time = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), time);
  if (error != std::errc{} || end == line.data() + line.size() || *end != ' ') return;
  imported.times.push_back(time);
  imported.files.emplace_back(std::string(end + 1, line.data() + line.size()));
}

}  // namespace

bool is_available(const Importer& importer) {
  const fs::path path = child_path(importer);
  return !path.empty() && ::access(path.c_str(), X_OK) == 0;
}

void watch_import_children(const std::atomic<bool>* stop) { watched = stop; }

ImportResult import_by_child(const Importer& importer, const ImportRequest& request) {
  if (!is_available(importer))
    throw Error(
        fmt::format("cannot read {}", request.file.string()),
        fmt::format("this program was built without {}", importer.library),
        fmt::format("convert the file to {}, or build where {} is installed", request.formats, importer.library));
  ImportResult imported;
  imported.folder = make_folder(request.file);
  std::vector<std::string> arguments = request.options;
  arguments.push_back(fs::absolute(request.file).string());
  arguments.push_back(imported.folder->string());
  const ChildResult result = run_child(child_path(importer), arguments, time_limit, watched.load());
  check(result, request, importer);
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) add_line(line, imported);
  if (imported.files.empty())
    throw Error(fmt::format("cannot read {}", request.file.string()),
                fmt::format("{} found no {} in it", importer.library, request.word),
                fmt::format("check the file with {}", importer.other_program));
  return imported;
}

}  // namespace nacre
