// Nacre: folders that are removed when they are no longer used.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace nacre {

/// A new, empty folder. Its destructor removes it with all that is in it, and so does whatever ends the program.
class ScratchFolder {
 public:
  /// `name`: how its name begins. It is made in the first of the `folders` that may be written to. Throws Error with
  /// the text `what` and the reason where there is none.
  ScratchFolder(const std::string& name, std::span<const std::filesystem::path> folders, const std::string& what);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The system's folder for temporary files (TMPDIR, else /tmp); empty where it is not there.
std::filesystem::path temporary_folder();

}  // namespace nacre
