// Nacre: collects small pieces of a file and writes them in large ones.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include "compute/math/vec.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {

/// Collects small pieces of a file, binary or text, and passes them on in large ones.
class Chunks {
 public:
  explicit Chunks(OutputFile& file) : file_(file) { text_.reserve(chunk_bytes + 4096); }

  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() >= chunk_bytes) flush();
  }
  template <class T>
  void raw(const T& value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    if (text_.size() >= chunk_bytes) flush();
  }
  /// The shortest text that reads back as the same number; as a float if the number was never more precise.
  void number(double value) {
    if (double(float(value)) == value)
      print("{}", float(value));
    else
      print("{}", value);
  }
  void point(const Vec3d& p, const char* before) {
    print("{}", before);
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) print(" ");
      number(p[axis]);
    }
    print("\n");
  }
  void flush() {
    file_.write(text_);
    text_.clear();
  }

 private:
  static constexpr std::size_t chunk_bytes = std::size_t(1) << 16;

  OutputFile& file_;
  std::string text_;
};

}  // namespace nacre
