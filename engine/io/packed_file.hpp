// Nacre: a file that may be packed with gzip, read piece by piece.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>

#include "engine/io/file_bytes.hpp"

namespace nacre {

/// Read from its beginning, unpacked. Throws Error if access is denied or the packed data are damaged.
class PackedFile {
 public:
  explicit PackedFile(const std::filesystem::path& path) : path_(path), file_(gzopen(path.c_str(), "rb")) {
    if (!file_) fail_reading(path, "access was denied", "check the file's permissions");
    gzbuffer(file_, 1 << 18);
  }
  ~PackedFile() { gzclose(file_); }
  PackedFile(const PackedFile&) = delete;
  PackedFile& operator=(const PackedFile&) = delete;

  /// Whether the file is packed; known once something was read.
  bool packed() const { return gzdirect(file_) == 0; }

  /// Reads up to `size` bytes; returns how many there were.
  std::size_t read(void* bytes, std::size_t size) {
    std::size_t done = 0;
    while (done < size) {
      const unsigned part = unsigned(std::min<std::size_t>(size - done, 1u << 30));
      const int got = gzread(file_, static_cast<char*>(bytes) + done, part);
      if (got < 0) fail_reading(path_, "its gzip data are damaged");
      if (got == 0) break;
      done += std::size_t(got);
    }
    return done;
  }

  /// Whether bytes follow.
  bool has_more() {
    char byte = 0;
    return read(&byte, 1) == 1;
  }

  void skip(std::size_t size) {
    std::array<char, 4096> bytes{};
    while (size > 0) {
      const std::size_t got = read(bytes.data(), std::min(size, bytes.size()));
      if (got == 0) fail_reading(path_, "it ends before its values begin");
      size -= got;
    }
  }

 private:
  std::filesystem::path path_;
  gzFile file_;
};

}  // namespace nacre
