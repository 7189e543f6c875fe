// Nacre: reads INRIMAGE-4: a text header in blocks of 256 bytes, then the values.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "engine/io/file_bytes.hpp"
#include "engine/io/text_cursor.hpp"
#include "engine/io/volume_geometry.hpp"
#include "engine/io/volume_readers.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t block = 256;
constexpr std::string_view magic = "#INRIMAGE-4#{", end_mark = "##}";

/// The lines KEY=VALUE of a header.
class InrHeader {
 public:
  InrHeader(std::string_view text, const fs::path& path) : path_(path) {
    while (!text.empty()) {
      const std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(text.size(), line.size() + 1));
      const std::size_t equals = line.find('=');
      if (line.starts_with('#') || equals == line.npos) continue;
      const std::string_view value = line.substr(equals + 1);
      fields_[std::string(line.substr(0, equals))] = value.substr(0, value.find_last_not_of(" \t\r") + 1);
    }
  }

  std::string_view text(const std::string& key) const {
    const auto found = fields_.find(key);
    return found == fields_.end() ? std::string_view() : found->second;
  }
  bool has(const std::string& key) const { return fields_.count(key) > 0; }

  std::int64_t count(const std::string& key, std::int64_t otherwise = -1) const {
    if (!has(key) && otherwise >= 0) return otherwise;
    std::int64_t value = 0;
    TextCursor cursor(text(key));
    if (!cursor.integer(value) || !(cursor.at_end() || cursor.word() == "bits")) fail(key);
    return value;
  }

  double number(const std::string& key, double otherwise) const {
    if (!has(key)) return otherwise;
    double value = 0;
    if (TextCursor cursor(text(key)); !cursor.number(value) || !cursor.at_end()) fail(key);
    return value;
  }

  [[noreturn]] void fail(const std::string& key) const {
    if (!has(key)) fail_reading(path_, fmt::format("its header has no {}", key));
    fail_reading(path_, fmt::format("its header says {}={}", key, text(key).substr(0, 40)));
  }

 private:
  const fs::path& path_;
  std::map<std::string, std::string_view> fields_;
};

std::endian byte_order(const InrHeader& header, std::int64_t bits) {
  const std::string_view cpu = header.text("CPU");
  if (cpu == "decm" || cpu == "alpha" || cpu == "pc" || (cpu.empty() && bits == 8)) return std::endian::little;
  if (cpu == "sun" || cpu == "sgi") return std::endian::big;
  header.fail("CPU");
}

/// Fixed-point numbers count in units of SCALE, a power of two: "2**-8".
double scale_of(const InrHeader& header) {
  if (!header.has("SCALE")) return 1;
  const std::string_view text = header.text("SCALE");
  const std::size_t stars = text.find("**");
  std::int64_t exponent = 0;
  if (stars == text.npos || text.substr(0, stars) != "2") header.fail("SCALE");
  if (TextCursor cursor(text.substr(stars + 2)); !cursor.integer(exponent) || std::abs(exponent) > 64)
    header.fail("SCALE");
  return std::exp2(double(exponent));
}

template <class T>
void take_values(Volume& volume, std::string_view bytes, std::endian order, double scale) {
  std::vector<T> values(volume.voxels());
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  if (order != std::endian::native) swap_bytes(values);
  if (scale == 1 || std::is_floating_point_v<T>) {
    volume.values = std::move(values);
    return;
  }
  std::vector<float> scaled(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) scaled[i] = float(double(values[i]) * scale);
  volume.values = std::move(scaled);
}

void set_position(Volume& volume, const InrHeader& header, const fs::path& path) {
  if (header.number("RX", 0) != 0 || header.number("RY", 0) != 0 || header.number("RZ", 0) != 0)
    fail_reading(path, "its header rotates it, which is not supported", "convert it to NRRD");
  std::array<Vec3d, 3> steps;
  constexpr std::array<const char*, 3> sizes{"VX", "VY", "VZ"}, positions{"TX", "TY", "TZ"};
  for (int axis = 0; axis < 3; ++axis) {
    if (!header.has(sizes[axis]))
      volume.warnings.push_back(fmt::format("The file gives no {}: a spacing of 1 is taken.", sizes[axis]));
    steps[axis][axis] = header.number(sizes[axis], 1);
    volume.origin[axis] = header.number(positions[axis], 0);
  }
  if (!is_finite(volume.origin)) fail_reading(path, "its origin is not a number", "correct its header");
  set_steps(volume, steps, path);
}

}  // namespace

Volume read_inr(const fs::path& path) {
  const std::string bytes = read_file(path, largest_gzip_ratio);
  if (!bytes.starts_with(magic)) fail_reading(path, "it does not begin with #INRIMAGE-4#", "check that it is INR");
  const std::size_t end = bytes.find(end_mark, magic.size());
  if (end == bytes.npos || end > 64 * block) fail_reading(path, "its header does not end");
  const std::size_t header_size = (end + end_mark.size() + block - 1) / block * block;
  const InrHeader header(std::string_view(bytes).substr(magic.size(), end - magic.size()), path);

  if (header.count("VDIM", 1) != 1)
    fail_reading(path, fmt::format("it has {} values per voxel", header.count("VDIM")), "open one component at a time");
  const std::string_view type = header.text("TYPE");
  const bool real = type == "float", is_signed = type == "signed fixed";
  if (!real && !is_signed && type != "unsigned fixed") header.fail("TYPE");
  const std::int64_t bits = header.count("PIXSIZE");
  const bool known =
      bits > 0 && bits <= 64 && bits % 8 == 0 && with_number_type(real, is_signed, int(bits / 8), [](auto) {});
  if (!known) header.fail("PIXSIZE");

  Volume volume;
  set_dims(volume, {header.count("XDIM"), header.count("YDIM"), header.count("ZDIM")}, std::size_t(bits / 8), path);
  set_position(volume, header, path);
  const std::size_t needed = volume.voxels() * std::size_t(bits / 8);
  if (bytes.size() < header_size + needed)
    fail_reading(path, fmt::format("it needs {} bytes of values and holds {}", needed,
                                   bytes.size() - std::min(bytes.size(), header_size)));
  warn_of_rest(volume, bytes.size() > header_size + needed);
  if (lower_extension(path) == ".gz") warn_unless_packed(volume, begins_as_gzip(path), path, "its name");
  const std::endian order = byte_order(header, bits);
  const double scale = scale_of(header);
  with_number_type(real, is_signed, int(bits / 8), [&](auto zero) {
    take_values<decltype(zero)>(volume, std::string_view(bytes).substr(header_size, needed), order, scale);
  });
  return volume;
}

}  // namespace nacre
