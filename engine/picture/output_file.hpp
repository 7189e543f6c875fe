// Nacre: a file that appears under its name only once it is whole.
#pragma once

#include <filesystem>

namespace nacre {

/// A new empty file beside `target`, renamed onto it by `commit` and removed if there was none. A symbolic link is
/// followed. Throws Error where the folder is missing or cannot be written, or `target` is no plain file.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }

  /// Throws Error where the file cannot be renamed; then nothing is left behind.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

/// What a user can do about an errno met while writing; empty where we know nothing better than the reason itself.
const char* advice_on_writing(int error);

/// Throws the Error for a file that could not be written.
[[noreturn]] void fail_to_write(const std::filesystem::path& file, int error);

}  // namespace nacre
