// Nacre: a file that a run can go on from: a text that says which run, then bytes, then a checksum of all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "engine/system/output_file.hpp"

namespace nacre {

/// Appears under its name when it is complete and on the disk; an older one stays until then. All members throw Error
/// as OutputFile does.
class CheckpointWriter {
 public:
  CheckpointWriter(const std::filesystem::path& file, const std::string& text);
  void put(std::span<const std::byte> bytes);
  void commit();

 private:
  OutputFile out_;
  std::uint32_t sum_ = 0;
};

/// Reads one. Throws Error where the file cannot be read, is no checkpoint, or is not as it was written: the checksum
/// is tested before anything is used.
class CheckpointReader {
 public:
  explicit CheckpointReader(const std::filesystem::path& file);
  const std::string& text() const { return text_; }
  /// The next bytes.
  void take(std::span<std::byte> bytes);
  /// Throws Error where not all bytes were taken.
  void finish() const;

 private:
  std::uint64_t check_sum();
  [[noreturn]] void damaged(const std::string& why) const;

  std::filesystem::path file_;
  std::ifstream stream_;
  std::string text_;
  std::uint64_t left_ = 0;  ///< bytes that can be taken
};

}  // namespace nacre
