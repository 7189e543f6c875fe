// Nacre: what was opened last.
#include "app/viewer/window/recent_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#include "compute/device/error.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_files = 10;

}  // namespace

fs::path state_folder() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state == '/') return fs::path(state) / "nacre";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? fs::path(home) / ".local/state/nacre" : fs::path();
}

RecentFiles::RecentFiles() : RecentFiles(state_folder().empty() ? fs::path() : state_folder() / "recent") {}

RecentFiles::RecentFiles(fs::path list) : list_(std::move(list)) { read(); }

void RecentFiles::read() {
  std::ifstream stream(list_);
  std::string line;
  std::error_code ignored;
  while (files_.size() < max_files && std::getline(stream, line))
    if (!line.empty() && fs::exists(line, ignored)) files_.push_back(line);
}

void RecentFiles::add(const fs::path& file) {
  std::error_code ignored;
  const fs::path whole = fs::absolute(file, ignored);
  if (list_.empty() || whole.string().find('\n') != std::string::npos) return;
  files_.erase(std::remove(files_.begin(), files_.end(), whole), files_.end());
  files_.insert(files_.begin(), whole);
  if (files_.size() > max_files) files_.resize(max_files);
  try {
    fs::create_directories(list_.parent_path(), ignored);
    OutputFile out(list_);
    for (const fs::path& each : files_) out.write(each.string() + "\n");
    out.commit();
  } catch (const Error&) {
  }
}

}  // namespace nacre
