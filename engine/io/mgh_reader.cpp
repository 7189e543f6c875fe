// Nacre: reads volumes of FreeSurfer (.mgh, and .mgz, which is the same packed with gzip).
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/label_names.hpp"
#include "engine/io/packed_file.hpp"
#include "engine/io/volume_geometry.hpp"
#include "engine/io/volume_readers.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t mgh_header_bytes = 284;
constexpr std::size_t longest_mgh_tail = std::size_t(16) << 20;  // a colour table of 1300 names takes 60 kB

struct MghHeader {
  std::array<std::int32_t, 4> dims{};  ///< the last: frames
  std::int32_t type = 0;
  bool oriented = false;
  std::array<Vec3d, 3> axes{Vec3d(-1, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0)};  ///< coronal, if the file does not say
  Vec3d spacing{1, 1, 1}, centre{0, 0, 0};
};

MghHeader parse_mgh(const std::array<char, mgh_header_bytes>& bytes, const fs::path& path) {
  std::size_t at = 0;
  const auto take = [&]<class T>(T) {
    const T value = load_number<T>(bytes.data() + at, std::endian::big);
    at += sizeof(T);
    return value;
  };
  const auto vector = [&] {
    std::array<double, 3> numbers{};
    for (double& number : numbers) number = double(take(float()));
    return Vec3d(numbers[0], numbers[1], numbers[2]);
  };
  if (const std::int32_t version = take(std::int32_t()); version != 1)
    fail_reading(path, fmt::format("its version is {}, not 1", version), "check that it is a volume of FreeSurfer");
  MghHeader header;
  for (std::int32_t& dim : header.dims) dim = take(std::int32_t());
  header.type = take(std::int32_t());
  take(std::int32_t());  // degrees of freedom
  header.oriented = take(std::int16_t()) != 0;
  if (!header.oriented) return header;
  header.spacing = vector();
  for (Vec3d& axis : header.axes) axis = vector();
  header.centre = vector();
  return header;
}

/// Calls `use(zero)` with a zero of the type of the values.
template <class Use>
void with_mgh_type(int type, const fs::path& path, Use use) {
  switch (type) {
    case 0: return use(std::uint8_t{});
    case 1: return use(std::int32_t{});
    case 3: return use(float{});
    case 4: return use(std::int16_t{});
    case 10: return use(std::uint16_t{});
    default:
      fail_reading(path, fmt::format("its values are of type {}, which is not known", type),
                   "convert it with `mri_convert -odt int`");
  }
}

/// The file has the world coordinates of the volume's centre, which is voxel dims / 2 counted from 0.
void set_mgh_orientation(Volume& volume, const MghHeader& header, const fs::path& path) {
  std::array<Vec3d, 3> steps;
  volume.origin = header.centre;
  for (int axis = 0; axis < 3; ++axis) {
    steps[std::size_t(axis)] = header.axes[std::size_t(axis)] * header.spacing[axis];
    volume.origin -= steps[std::size_t(axis)] * (double(header.dims[std::size_t(axis)]) / 2);
  }
  volume.space = "right-anterior-superior";
  if (!is_finite(volume.origin)) fail_reading(path, "its origin is not a number", "correct its header");
  set_steps(volume, steps, path);
  if (!header.oriented)
    volume.warnings.push_back("It does not say where its axes point; coronal slices of 1 mm are assumed.");
}

/// What follows the values: five numbers of the scanner, then tags. Most tags have a length of 8 bytes, old ones have
/// none. Empty if there is no colour table before something unknown.
LabelTable labels_in_mgh_tail(std::string_view tail) {
  constexpr std::size_t scanner_bytes = 20;
  constexpr std::int32_t old_colour_table = 1, old_real_ras = 2, colour_table = 5, old_geometry = 20,
                         old_transform = 30;
  if (tail.size() < scanner_bytes) return {};
  tail.remove_prefix(scanner_bytes);
  while (tail.size() > 4) {
    const auto tag = load_number<std::int32_t>(tail.data(), std::endian::big);
    tail.remove_prefix(4);
    if (tag == old_colour_table) return label_table_in_bytes(tail);
    if (tag == old_real_ras || tag == old_geometry) return {};  // of surfaces
    const std::size_t size_bytes = tag == old_transform ? 4 : 8;
    if (tail.size() < size_bytes) return {};
    const std::int64_t length = size_bytes == 4 ? load_number<std::int32_t>(tail.data(), std::endian::big)
                                                : load_number<std::int64_t>(tail.data(), std::endian::big);
    tail.remove_prefix(size_bytes);
    if (tag == colour_table) return label_table_in_bytes(tail);
    if (length < 0 || std::uint64_t(length) > tail.size()) return {};
    tail.remove_prefix(std::size_t(length));
  }
  return {};
}

}  // namespace

Volume read_mgh(const fs::path& path) {
  PackedFile file(path);
  std::array<char, mgh_header_bytes> bytes{};
  if (const std::size_t got = file.read(bytes.data(), bytes.size()); got < bytes.size())
    fail_reading(path, fmt::format("its header has {} of {} bytes", got, bytes.size()));
  const MghHeader header = parse_mgh(bytes, path);
  if (header.dims[3] != 1)
    fail_reading(path, fmt::format("it has {} frames: one value per voxel is needed", header.dims[3]),
                 "extract one with `mri_convert --frame 0`");
  Volume volume;
  with_mgh_type(header.type, path, [&](auto zero) {
    using T = decltype(zero);
    set_dims(volume, {header.dims[0], header.dims[1], header.dims[2]}, sizeof(T), path);
    set_mgh_orientation(volume, header, path);
    std::error_code code;
    const std::size_t needed = volume.voxels() * sizeof(T);
    check_stored(fs::file_size(path, code), needed, file.packed() ? double(largest_gzip_ratio) : 1.0, path);
    std::vector<T> values(volume.voxels());
    if (file.read(values.data(), needed) != needed) fail_reading(path, "it ends before its last voxel");
    if constexpr (std::endian::native == std::endian::little) swap_bytes(values);
    volume.values = std::move(values);
  });
  if (lower_extension(path) == ".mgz") warn_unless_packed(volume, file.packed(), path, "its name");
  std::string tail(longest_mgh_tail, '\0');
  tail.resize(file.read(tail.data(), tail.size()));
  LabelTable labels = labels_in_mgh_tail(tail);
  volume.label_names = std::move(labels.names);
  volume.label_colours = std::move(labels.colours);
  volume.unit = "mm";
  return volume;
}

}  // namespace nacre
