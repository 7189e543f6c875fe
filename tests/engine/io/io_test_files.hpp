// Nacre: files for the tests of the readers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "tests/engine/io/temporary_folder.hpp"
#include "tests/paths.hpp"

namespace nacre::test {

namespace fs = std::filesystem;

/// Writes small files into a folder of its own and opens them.
class ReaderTest : public ::testing::Test {
 protected:
  /// Writes a file into the folder; its path.
  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  /// The first step of what the file holds.
  Surface read(const std::string& name, const std::string& content) const {
    return open_surface({write(name, content)}).load(0);
  }

  /// The message with which opening fails, empty if it does not.
  std::string failure(const std::string& name, const std::string& content) const {
    return failure({write(name, content)});
  }
  static std::string failure(const std::vector<fs::path>& paths) {
    try {
      open_surface(paths);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  TemporaryFolder folder_;
};

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

/// Bytes of a number, lowest first unless `big`.
template <class T>
std::string bytes_of(T value, bool big = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Sum of the triangles' areas.
inline double area(const Surface& surface) {
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    const Vec3d& a = surface.points[t.a];
    sum += length(cross(surface.points[t.b] - a, surface.points[t.c] - a)) / 2;
  }
  return sum;
}

/// Volume that the triangles enclose; positive if they face outwards.
inline double volume(const Surface& surface) {
  double sum = 0;
  for (const Triangle& t : surface.triangles)
    sum += dot(surface.points[t.a], cross(surface.points[t.b], surface.points[t.c])) / 6;
  return sum;
}

}  // namespace nacre::test
