// Nacre: reads NIfTI-1, NIfTI-2 and ANALYZE. The nifti library reads the header; we read the values, since the library
// turns NaN into 0.
#include <fmt/format.h>
#include <nifti/nifti2_io.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/label_names.hpp"
#include "engine/io/mapped_values.hpp"
#include "engine/io/packed_file.hpp"
#include "engine/io/volume_geometry.hpp"
#include "engine/io/volume_readers.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

struct Free {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};
using Image = std::unique_ptr<nifti_image, Free>;

/// The file that contains the header: the .hdr beside an .img.
fs::path header_path(const fs::path& path) {
  if (format_extension(path) != "img") return path;
  const bool packed = path.extension() == ".gz";
  const fs::path stem =
      packed ? fs::path(path).replace_extension().replace_extension() : fs::path(path).replace_extension();
  for (const char* extension : {".hdr", ".hdr.gz", ".HDR"}) {
    fs::path header = stem;
    header += extension;
    std::error_code code;
    if (fs::is_regular_file(header, code)) return header;
  }
  fail_reading(path, "there is no .hdr file beside it", "put its header there");
}

/// What is checked before the library sees a header: it crashes on some headers, and invents values for others.
struct RawHeader {
  int version = 1;
  std::int64_t rank = 0;
  std::array<std::int64_t, 7> dims{};
  std::array<double, 3> spacing{};
  double offset = 0;  ///< of the values; 0 in a file of its own
  int type = 0, bits = 0;
  double slope = 0, intercept = 0;
  std::array<double, 6> quaternion{};  ///< its b, c, d, and the offset that goes with it
  bool analyze = false;                ///< no NIfTI: its fields for slope and orientation mean something else
};

RawHeader parse(const char* bytes, int version, std::endian order) {
  RawHeader header;
  header.version = version;
  const bool one = version == 1;
  const auto dim = [&](std::size_t i) -> std::int64_t {
    return one ? load_number<std::int16_t>(bytes + 40 + 2 * i, order)
               : load_number<std::int64_t>(bytes + 16 + 8 * i, order);
  };
  header.rank = dim(0);
  for (std::size_t i = 0; i < 7; ++i) header.dims[i] = dim(i + 1);
  for (std::size_t i = 0; i < 3; ++i)
    header.spacing[i] =
        one ? double(load_number<float>(bytes + 80 + 4 * i, order)) : load_number<double>(bytes + 112 + 8 * i, order);
  header.offset =
      one ? double(load_number<float>(bytes + 108, order)) : double(load_number<std::int64_t>(bytes + 168, order));
  header.type = load_number<std::int16_t>(bytes + (one ? 70 : 12), order);
  header.bits = load_number<std::int16_t>(bytes + (one ? 72 : 14), order);
  header.analyze = one && (bytes[344] != 'n' || (bytes[345] != 'i' && bytes[345] != '+'));
  if (header.analyze) return header;
  const auto real = [&](std::size_t of_one, std::size_t of_two) {
    return one ? double(load_number<float>(bytes + of_one, order)) : load_number<double>(bytes + of_two, order);
  };
  header.slope = real(112, 176);
  header.intercept = real(116, 184);
  for (std::size_t i = 0; i < 6; ++i) header.quaternion[i] = real(256 + 4 * i, 352 + 8 * i);
  return header;
}

/// The bytes of the header. Throws Error if the file does not begin as one.
RawHeader raw_header(const fs::path& path) {
  std::array<char, 540> head{};
  const std::size_t got = PackedFile(path).read(head.data(), head.size());
  for (const std::endian order : {std::endian::little, std::endian::big})
    for (const int version : {1, 2}) {
      const std::size_t size = version == 1 ? 348 : 540;
      if (std::size_t(load_number<std::uint32_t>(head.data(), order)) != size) continue;
      if (got < size) fail_reading(path, fmt::format("its header has {} of {} bytes", got, size));
      return parse(head.data(), version, order);
    }
  fail_reading(path, "it does not begin like a NIfTI header", "check that it is NIfTI");
}

Image read_header(const fs::path& path) {
  nifti_set_debug_level(0);
  Image image(nifti_image_read(path.c_str(), 0));
  if (!image) fail_reading(path, "its header is damaged");
  return image;
}

void check_dimensions(const RawHeader& header, const fs::path& path) {
  constexpr std::array<const char*, 7> names{"", "", "", "time", "values per voxel", "dimension 6", "dimension 7"};
  if (header.rank < 1 || header.rank > 7) fail_reading(path, fmt::format("it has {} dimensions", header.rank));
  if (header.rank < 3) fail_reading(path, fmt::format("it has {} dimensions", header.rank), "open a volume");
  for (std::size_t d = 3; d < std::size_t(header.rank); ++d)
    if (header.dims[d] != 1 && header.dims[d] != 0)
      fail_reading(path, fmt::format("it has {} entries along its dimension {} ({})", header.dims[d], d + 1, names[d]),
                   "extract one of them: one value per voxel is needed");
  if (!(header.offset >= 0 && header.offset < 1e15))
    fail_reading(path, fmt::format("its values begin at byte {:.6g}", header.offset));
}

/// Calls `use(zero)` with a zero of the type of the values. Throws Error for complex numbers, colours and bits.
template <class Use>
void with_datatype(int type, const fs::path& path, Use use) {
  switch (type) {
    case DT_UINT8: return use(std::uint8_t{});
    case DT_INT8: return use(std::int8_t{});
    case DT_UINT16: return use(std::uint16_t{});
    case DT_INT16: return use(std::int16_t{});
    case DT_UINT32: return use(std::uint32_t{});
    case DT_INT32: return use(std::int32_t{});
    case DT_UINT64: return use(std::uint64_t{});
    case DT_INT64: return use(std::int64_t{});
    case DT_FLOAT32: return use(float{});
    case DT_FLOAT64: return use(double{});
    default:
      fail_reading(path, fmt::format("its values are of type {}, not plain numbers", nifti_datatype_string(type)),
                   "convert it to integers or floats");
  }
}

std::array<Vec3d, 3> steps_of(const nifti_dmat44& to_world) {
  std::array<Vec3d, 3> steps;
  for (int axis = 0; axis < 3; ++axis) steps[axis] = {to_world.m[0][axis], to_world.m[1][axis], to_world.m[2][axis]};
  return steps;
}

/// sform before qform; a sheared sform is replaced by the qform, which cannot be sheared.
void set_orientation(Volume& volume, const nifti_image& image, const RawHeader& header, const fs::path& path) {
  bool by_s = image.sform_code > 0;
  const bool by_q = image.qform_code > 0;
  if (by_s && by_q && shear_of(steps_of(image.sto_xyz)) > 1e-3) {
    by_s = false;
    volume.warnings.push_back("Its sform is sheared; the qform is used instead.");
  }
  const std::array<double, 3>& sizes = header.spacing;
  const std::array<Vec3d, 3> straight{Vec3d(std::abs(sizes[0]), 0, 0), Vec3d(0, std::abs(sizes[1]), 0),
                                      Vec3d(0, 0, std::abs(sizes[2]))};
  // The library takes 0 for what is no number, and a quaternion that is too long for one of length 1.
  const auto& [b, c, d, x, y, z] = header.quaternion;
  if (!by_s && by_q && !(std::isfinite(x + y + z) && b * b + c * c + d * d < 1.001))
    fail_reading(path, "its qform is not a rotation and a translation", "correct its header");
  if (!by_s) set_steps(volume, straight, path);  // for its errors: the library replaces 0 and non-numbers by 1
  if (by_s || by_q) {
    const nifti_dmat44& to_world = by_s ? image.sto_xyz : image.qto_xyz;
    volume.origin = {to_world.m[0][3], to_world.m[1][3], to_world.m[2][3]};
    volume.space = "right-anterior-superior";
    if (!is_finite(volume.origin)) fail_reading(path, "its origin is not a number", "correct its header");
    set_steps(volume, steps_of(to_world), path);
    return;
  }
  if (image.nifti_type == NIFTI_FTYPE_ANALYZE)
    volume.warnings.push_back("It is an ANALYZE file, which does not say where its axes point.");
  else
    volume.warnings.push_back("It has neither sform nor qform; its axes are assumed to be those of the world.");
}

std::string unit_of(const nifti_image& image) {
  switch (image.xyz_units) {
    case NIFTI_UNITS_METER: return "m";
    case NIFTI_UNITS_MM: return "mm";
    case NIFTI_UNITS_MICRON: return "um";
    default: return "";
  }
}

/// From the first extension that names labels.
LabelTable label_table_of(const nifti_image& image) {
  constexpr int head = 8;  // its size and its code precede its text
  for (int i = 0; i < image.num_ext; ++i) {
    const nifti1_extension& extension = image.ext_list[i];
    const bool known =
        extension.ecode == NIFTI_ECODE_CARET || extension.ecode == NIFTI_ECODE_IGNORE;  // TotalSegmentator
    if (!known || !extension.edata || extension.esize <= head) continue;
    LabelTable labels = label_table_in_xml({extension.edata, std::size_t(extension.esize - head)});
    if (!labels.names.empty()) return labels;
  }
  return {};
}

/// value * slope + intercept, if the file has a slope. A slope that is no number counts as none, as in nibabel; an
/// intercept that is none, with a slope, leaves the values unknown.
template <class T>
void set_values(Volume& volume, VoxelArray<T> values, double slope, double intercept, const fs::path& path) {
  if (!std::isfinite(slope))
    volume.warnings.push_back(
        fmt::format("Its scl_slope is {}, not a number: the values are taken as they are stored.", slope));
  else if (slope != 0 && !std::isfinite(intercept))
    fail_reading(path, fmt::format("its scl_inter is {}, not a number", intercept), "correct its header");
  const bool scaled = std::isfinite(slope) && slope != 0 && !(slope == 1 && intercept == 0);
  if (!scaled) {
    volume.values = std::move(values);
    return;
  }
  using Scaled = std::conditional_t<(sizeof(T) > 2 && !std::is_same_v<T, float>), double, float>;
  std::vector<Scaled> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[i] = Scaled(double(values[i]) * slope + intercept);
  volume.values = std::move(result);
}

template <class T>
VoxelArray<T> nifti_values(Volume& volume, const fs::path& data, std::size_t offset, bool swapped,
                           const fs::path& path) {
  PackedFile file(data);
  file.skip(offset);
  std::vector<T> values(volume.voxels());
  const std::size_t needed = values.size() * sizeof(T);
  if (file.read(values.data(), needed) != needed) fail_reading(path, "it ends before its last voxel");
  if (swapped) swap_bytes(values);
  warn_of_rest(volume, file.has_more());
  if (data.string().ends_with(".gz")) warn_unless_packed(volume, file.packed(), data, "its name");
  return values;
}

fs::path image_path(const nifti_image& image, const fs::path& header) {
  std::error_code code;
  if (!image.iname || !fs::is_regular_file(image.iname, code))
    fail_reading(header, "the file with its values is missing", "put it beside the header");
  return image.iname;
}

Volume open_nifti(const fs::path& path, Values how) {
  const fs::path header = header_path(path);
  const RawHeader raw = raw_header(header);
  check_dimensions(raw, path);
  Volume volume;
  with_datatype(raw.type, path, [&](auto zero) {
    set_dims(volume, {raw.dims[0], raw.dims[1], raw.dims[2]}, sizeof(zero), path);
  });
  const Image image = read_header(header);
  set_orientation(volume, *image, raw, path);
  LabelTable labels = label_table_of(*image);
  volume.label_names = std::move(labels.names);
  volume.label_colours = std::move(labels.colours);
  volume.unit = unit_of(*image);
  with_datatype(raw.type, path, [&](auto zero) {
    using T = decltype(zero);
    const fs::path data = image_path(*image, header);
    std::error_code code;
    const std::size_t needed = volume.voxels() * sizeof(T);
    const std::string name = data.string();
    const bool packed = name.size() > 3 && name.ends_with(".gz");
    check_stored(fs::file_size(data, code), needed, packed ? double(largest_gzip_ratio) : 1.0, path);
    const std::size_t offset = std::size_t(std::max<std::int64_t>(image->iname_offset, 0));
    const bool swapped = sizeof(T) > 1 && image->byteorder != nifti_short_order();
    VoxelArray<T> values;
    if (!packed && !swapped && can_map(how, offset, volume.voxels(), sizeof(T)) && !begins_as_gzip(data)) {
      const std::uintmax_t stored = fs::file_size(data, code);
      if (stored < offset + needed) fail_reading(path, "it ends before its last voxel");
      warn_of_rest(volume, stored > offset + needed);
      values = mapped_values<T>(data, offset, volume.voxels());
    } else {
      values = nifti_values<T>(volume, data, offset, swapped, path);
    }
    if (raw.bits != int(8 * sizeof(T)))
      volume.warnings.push_back(fmt::format("Its header says {} bits per voxel, but its type has {}, which are read.",
                                            raw.bits, 8 * sizeof(T)));
    set_values(volume, std::move(values), raw.slope, raw.intercept, path);
  });
  return volume;
}

}  // namespace

Volume read_nifti(const fs::path& path) { return open_nifti(path, Values::read); }
Volume map_nifti(const fs::path& path) { return open_nifti(path, Values::mapped); }

}  // namespace nacre
