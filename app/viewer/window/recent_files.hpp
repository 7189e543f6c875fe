// Nacre: what was opened last, kept between runs.
#pragma once

#include <filesystem>
#include <vector>

namespace nacre {

/// The folder of what the viewer keeps between runs; empty: the user has none.
std::filesystem::path state_folder();

/// One path per line in $XDG_STATE_HOME/nacre/recent (~/.local/state/nacre/recent); the latest first, at most ten.
class RecentFiles {
 public:
  RecentFiles();  ///< reads the list; empty where there is none
  explicit RecentFiles(std::filesystem::path list);

  const std::vector<std::filesystem::path>& files() const { return files_; }  ///< those that are still there
  /// Puts it in front and writes the list. A folder that cannot be written is no matter.
  void add(const std::filesystem::path& file);

 private:
  void read();

  std::filesystem::path list_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace nacre
