// Nacre: files that appear under their name only when they are whole.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace nacre {

/// Writes beside `target` and renames on `commit`, so that nobody ever meets half a file and an older one stays until
/// then. A target that is a link is followed, also to a file that is not there yet; one that is a device or pipe
/// (/dev/stdout) is written directly, or refused where the format cannot be written so.
/// Every failure (missing or unwritable folder, full disk, file size limit) throws Error that names the target and why.
class OutputFile {
 public:
  enum class Devices { written, refused };

  explicit OutputFile(std::filesystem::path target, Devices devices = Devices::written);
  ~OutputFile();  ///< removes the temporary unless committed
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Flushes, closes and renames. Nothing may be written afterwards.
  void commit();

  /// Where the bytes are until `commit`, for another program that writes them: in the target's folder, with the
  /// target's extension.
  const std::filesystem::path& temporary() const { return temporary_; }

 private:
  [[noreturn]] void fail(int error_number) const;
  void remove_temporary() const;

  std::filesystem::path target_;
  std::filesystem::path destination_;  // the target with links followed
  std::filesystem::path temporary_;    // the same as destination_ where written directly
  std::FILE* stream_ = nullptr;
  bool direct_ = false;
};

/// Throws as an OutputFile would where `target` cannot be written: before hours of work rather than after. Leaves nothing
/// behind; devices and pipes are not opened, since who reads them would take that for the end.
void check_writable(const std::filesystem::path& target);

/// What a user can do about an errno met while writing; empty where we know nothing better than the reason itself.
const char* advice_on_writing(int error_number);

/// Puts a file or folder on the list of what `remove_unfinished_files` removes, or takes it off.
void add_unfinished(const std::filesystem::path& path);
void drop_unfinished(const std::filesystem::path& path) noexcept;

/// Removes the temporaries of all files not committed, for a program that leaves without unwinding.
void remove_unfinished_files() noexcept;

/// The same, and ends the program while other threads may still be at work; none of them begins a file any more. Not for a
/// signal handler.
[[noreturn]] void leave_without_unfinished_files(int status) noexcept;

}  // namespace nacre
