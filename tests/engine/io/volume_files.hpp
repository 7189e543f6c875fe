// Nacre: files of volumes for the tests of their readers.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/io/volume_reader.hpp"
#include "tests/engine/io/io_test_files.hpp"

namespace nacre::test {

/// The same bytes, packed with gzip.
inline std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, uLong(bytes.size())) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// The bytes of 0, 1, 2, ..., count - 1 as numbers of type T.
template <class T>
std::string counting(std::size_t count, bool big = false) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += bytes_of(T(i), big);
  return bytes;
}

/// All values as doubles.
inline std::vector<double> values_of(const Volume& volume) {
  return std::visit([](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
                    volume.values);
}

/// 0, 1, 2, ..., count - 1.
inline std::vector<double> count_up(std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = double(i);
  return values;
}

inline void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-6) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "component " << axis;
}

/// Writes small volumes into a folder of its own and reads them.
class VolumeTest : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  Volume read(const std::string& name, const std::string& content) const { return read_volume(write(name, content)); }

  /// The message with which reading fails, empty if it does not.
  static std::string failure(const fs::path& path) {
    try {
      read_volume(path);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
  std::string failure(const std::string& name, const std::string& content) const {
    return failure(write(name, content));
  }

  TemporaryFolder folder_;
};

}  // namespace nacre::test
