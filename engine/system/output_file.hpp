// Nacre: files that appear under their name only when they are complete.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace nacre {

/// Writes beside `target` and renames on `commit`, so that nobody ever sees an incomplete file and an older one stays
/// until then. If the target is a link, the link is followed, even to a file that does not exist yet. If it is a device
/// or pipe (/dev/stdout), it is written directly, or refused if the format does not allow that. Every failure (missing
/// or unwritable folder, full disk, file size limit) throws Error with the name of the target and the reason.
class OutputFile {
 public:
  enum class Devices { written, refused };

  explicit OutputFile(std::filesystem::path target, Devices devices = Devices::written);
  ~OutputFile();  ///< removes the temporary unless committed
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// What is written is on the disk when this returns, so that also a machine that fails leaves a whole file.
  void sync();

  /// Flushes, closes and renames. Nothing may be written afterwards.
  void commit();

  /// Where the bytes are until `commit`, for another program that writes them: in the folder of the target, with its
  /// extension.
  const std::filesystem::path& temporary() const { return temporary_; }

 private:
  [[noreturn]] void fail(int error_number) const;
  void remove_temporary() const;

  std::filesystem::path target_;
  std::filesystem::path destination_;  // the target with links followed
  std::filesystem::path temporary_;    // the same as destination_ if written directly
  std::FILE* stream_ = nullptr;
  bool direct_ = false;
};

/// Throws as an OutputFile would if `target` cannot be written: before hours of work rather than after. Leaves nothing
/// behind. Devices and pipes are not opened, since their readers would take that for the end.
void check_writable(const std::filesystem::path& target);

/// What a user can do about an errno from writing; empty if we know nothing better than the reason itself.
const char* advice_on_writing(int error_number);

/// Adds a file or folder to the list of what `remove_unfinished_files` removes, or removes it from the list.
void add_unfinished(const std::filesystem::path& path);
void drop_unfinished(const std::filesystem::path& path) noexcept;

/// Removes the temporaries of all files not committed, for a program that exits without unwinding.
void remove_unfinished_files() noexcept;

/// The same, and ends the program while other threads may still be working; none of them can begin another file. Not
/// for a signal handler.
[[noreturn]] void leave_without_unfinished_files(int status) noexcept;

}  // namespace nacre
