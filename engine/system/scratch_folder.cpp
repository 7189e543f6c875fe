// Nacre: folders that are removed when they are no longer used.
#include "engine/system/scratch_folder.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <system_error>

#include "compute/device/error.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {

namespace fs = std::filesystem;

fs::path temporary_folder() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return error ? fs::path() : folder;
}

ScratchFolder::ScratchFolder(const std::string& name, std::span<const fs::path> folders, const std::string& what) {
  int error = ENOENT;
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    std::string path = (folder / (name + "-XXXXXX")).string();  // mkdtemp puts letters for these
    if (::mkdtemp(path.data())) {
      path_ = path;
      add_unfinished(path_);
      return;
    }
    error = errno;
  }
  throw Error(what, fmt::format("no temporary folder: {}", std::generic_category().message(error)),
              "set TMPDIR to a folder that you may write to");
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  drop_unfinished(path_);
}

}  // namespace nacre
