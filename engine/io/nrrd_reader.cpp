// Nacre: reads NRRD through teem.
#include <fmt/format.h>
#include <teem/nrrd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>

#include "engine/io/build_surface.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/label_names.hpp"
#include "engine/io/mapped_values.hpp"
#include "engine/io/nrrd_header.hpp"
#include "engine/io/nrrd_layers.hpp"
#include "engine/io/volume_geometry.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/io/volume_readers.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_layers = 65536;

struct Delete {
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
  void operator()(NrrdIoState* state) const { nrrdIoStateNix(state); }
  void operator()(char* text) const { std::free(text); }
};

/// The innermost message of teem: "[nrrd] function: what is wrong".
std::string complaint() {
  const std::unique_ptr<char, Delete> text(biffGetDone(NRRD));
  if (!text) return "teem gives no reason";
  std::string lines = text.get();
  while (!lines.empty() && lines.back() == '\n') lines.pop_back();
  std::string last = lines.substr(lines.rfind('\n') + 1);
  if (const std::size_t colon = last.find(": "); colon != last.npos) last = last.substr(colon + 2);
  for (char& c : last)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return last.substr(0, 200);
}

struct NrrdEncoded {
  const NrrdEncoding* encoding = nullptr;
  bool skips = false;    ///< something before the values
  bool swapped = false;  ///< bytes of numbers are in the other order
};

int other_order() { return std::endian::native == std::endian::little ? airEndianBig : airEndianLittle; }

/// Reads the header and, unless `header_only`, the values.
std::unique_ptr<Nrrd, Delete> load(const fs::path& path, bool header_only, NrrdEncoded* encoded = nullptr) {
  const std::unique_ptr<NrrdIoState, Delete> state(nrrdIoStateNew());
  std::unique_ptr<Nrrd, Delete> nrrd(nrrdNew());
  if (!state || !nrrd) throw std::bad_alloc();
  nrrdStateVerboseIO = 0;
  state->skipData = header_only;
  if (nrrdLoad(nrrd.get(), path.c_str(), state.get()) != 0) fail_reading(path, complaint());
  if (encoded)
    *encoded = {state->encoding, state->byteSkip != 0 || state->lineSkip != 0, state->endian == other_order()};
  if (state->byteSkip < -1)
    fail_reading(path, fmt::format("its byte skip is {}", state->byteSkip), "correct its header");
  return nrrd;
}

/// How many bytes a stored byte may become; uncompressed data take at least half a character per byte.
double ratio_of(const NrrdEncoding* encoding, std::size_t bytes_per_voxel) {
  if (encoding == nrrdEncodingRaw) return 1;
  if (encoding == nrrdEncodingHex) return 0.5;
  if (encoding == nrrdEncodingAscii) return double(bytes_per_voxel);
  if (encoding == nrrdEncodingGzip) return double(largest_gzip_ratio);
  return 50000;  // bzip2 makes 45 bytes of a block of 900,000 zeros
}

Vec3d direction_of(const Nrrd& nrrd, unsigned axis) {
  const double* d = nrrd.axis[axis].spaceDirection;
  return {d[0], d[1], d[2]};
}

/// Whether this axis is spatial: decided by its direction if the file has directions, otherwise by its kind.
bool is_spatial(const Nrrd& nrrd, unsigned axis) {
  const NrrdAxisInfo& info = nrrd.axis[axis];
  if (nrrd.spaceDim > 0) {
    const Vec3d direction = direction_of(nrrd, axis);
    const bool only_in_time = nrrd.spaceDim == 4 && direction == Vec3d() && info.spaceDirection[3] != 0;
    return !std::isnan(info.spaceDirection[0]) && !only_in_time;
  }
  return info.kind == nrrdKindUnknown || info.kind == nrrdKindDomain || info.kind == nrrdKindSpace;
}

std::string describe_axis(const Nrrd& nrrd, unsigned axis) {
  const NrrdAxisInfo& info = nrrd.axis[axis];
  const std::string kind = info.kind == nrrdKindUnknown ? "" : std::string(airEnumStr(nrrdKind, info.kind)) + ", ";
  return fmt::format("axis {} ({}{} entries)", axis, kind, info.size);
}

struct NrrdAxes {
  std::array<unsigned, 3> spatial{};
  std::optional<unsigned> layers;  ///< an axis with several entries that is not spatial
};

/// Other axes may have one entry, and one of them several. If four axes have no description, one with a single entry
/// counts as time, or as the only component.
NrrdAxes find_axes(const Nrrd& nrrd, const fs::path& path) {
  const char* one = "extract one entry of that axis, for example with `unu slice`";
  std::vector<unsigned> axes;
  NrrdAxes result;
  unsigned spatial = 0;
  for (unsigned a = 0; a < nrrd.dim; ++a) spatial += is_spatial(nrrd, a);
  for (unsigned a = 0; a < nrrd.dim; ++a) {
    const bool single = nrrd.axis[a].size == 1;
    if (is_spatial(nrrd, a) && !(single && spatial > 3 && (a == 0 || a + 1 == nrrd.dim))) {
      axes.push_back(a);
    } else if (!single) {
      if (result.layers)
        fail_reading(path, describe_axis(nrrd, a) + " is not a spatial axis: one value per voxel is needed", one);
      result.layers = a;
    } else {
      spatial -= is_spatial(nrrd, a);
    }
  }
  if (axes.size() > 3)
    fail_reading(
        path, fmt::format("it has {} dimensions; {} is too many", axes.size(), describe_axis(nrrd, axes.back())), one);
  if (axes.size() < 3) fail_reading(path, fmt::format("it has {} of the 3 spatial axes", axes.size()), "open a volume");
  result.spatial = {axes[0], axes[1], axes[2]};
  return result;
}

/// Throws Error if one value per voxel can be had neither from all layers nor from the chosen one.
void check_layers(const Nrrd& nrrd, const NrrdAxes& axes, bool segmented, int layer, const fs::path& path) {
  const std::size_t layers = axes.layers ? nrrd.axis[*axes.layers].size : 1;
  if (layer >= 0 && std::size_t(layer) >= layers)
    fail_reading(path, fmt::format("it has no layer {}", layer),
                 layers == 1 ? "it has only one: leave --layer out" : fmt::format("choose 0 to {}", layers - 1));
  if (axes.layers && layer < 0 && !segmented)
    fail_reading(path, describe_axis(nrrd, *axes.layers) + " is not a spatial axis: one value per voxel is needed",
                 "choose one with --layer");
}

/// The signed spacing of an axis of a file without directions; 1 with a warning if it is not given.
double spacing_of(const NrrdAxisInfo& info, unsigned axis, Volume& volume) {
  if (!std::isnan(info.spacing)) return info.spacing;
  if (!std::isnan(info.min) && !std::isnan(info.max)) {
    const double steps = info.center == nrrdCenterCell ? double(info.size) : double(info.size) - 1;
    return (info.max - info.min) / steps;
  }
  volume.warnings.push_back(fmt::format("The file gives no spacing for axis {}; 1 is assumed.", axis));
  return 1;
}

void set_orientation(Volume& volume, const Nrrd& nrrd, const std::array<unsigned, 3>& axes, const fs::path& path) {
  std::array<Vec3d, 3> steps;
  for (int i = 0; i < 3; ++i) {
    if (nrrd.spaceDim > 0) {
      steps[i] = direction_of(nrrd, axes[i]);
    } else {
      const NrrdAxisInfo& info = nrrd.axis[axes[i]];
      steps[i][i] = spacing_of(info, axes[i], volume);
      const double half = info.center == nrrdCenterCell ? 0.5 * steps[i][i] : 0;
      if (std::isfinite(info.min)) volume.origin[i] = info.min + half;
    }
  }
  if (nrrd.spaceDim > 0)
    for (int i = 0; i < 3; ++i)
      if (!std::isnan(nrrd.spaceOrigin[i])) volume.origin[i] = nrrd.spaceOrigin[i];
  if (!is_finite(volume.origin)) fail_reading(path, "its origin is not a number", "correct its header");
  if (nrrd.space != nrrdSpaceUnknown) volume.space = airEnumStr(nrrdSpace, nrrd.space);
  set_steps(volume, steps, path);
}

/// Warns where the stored bytes do not look like what the header says. teem reads raw values under the name of gzip,
/// and does not look at what follows raw ones.
void check_encoding(Volume& volume, const NrrdEncoded& encoded, const NrrdStorage& storage, std::size_t needed,
                    const fs::path& path) {
  if (encoded.skips) return;
  if (encoded.encoding == nrrdEncodingRaw) warn_of_rest(volume, storage.bytes > needed);
  if (encoded.encoding != nrrdEncodingGzip) return;
  if (storage.files.empty()) warn_unless_packed(volume, begins_as_gzip(path, storage.header_bytes), path, "its header");
  for (const fs::path& file : storage.files) warn_unless_packed(volume, begins_as_gzip(file), file, "the header");
}

/// Where the value of a voxel of a layer is.
class NrrdIndex {
 public:
  NrrdIndex(const Nrrd& nrrd, const NrrdAxes& axes) {
    std::size_t step = 1;
    for (unsigned a = 0; a < nrrd.dim; ++a) {
      for (std::size_t i = 0; i < 3; ++i)
        if (axes.spatial[i] == a) step_[i] = step, size_[i] = nrrd.axis[a].size;
      if (axes.layers && *axes.layers == a) layer_step_ = step;
      step *= nrrd.axis[a].size;
    }
  }
  std::size_t operator()(std::size_t voxel, std::size_t layer) const {
    const std::size_t i = voxel % size_[0], j = voxel / size_[0] % size_[1], k = voxel / size_[0] / size_[1];
    return i * step_[0] + j * step_[1] + k * step_[2] + layer * layer_step_;
  }

 private:
  std::array<std::size_t, 3> step_{}, size_{};
  std::size_t layer_step_ = 0;
};

/// Those of one layer, or of the only one.
template <class T>
std::vector<T> copied_values(const Volume& volume, const T* from, const NrrdIndex& index_of, std::size_t layer) {
  std::vector<T> values(volume.voxels());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = from[index_of(i, layer)];
  return values;
}

using HeldNrrd = std::unique_ptr<Nrrd, Delete>;

/// The values as teem has read them.
class NrrdBytes : public HeldBytes {
 public:
  explicit NrrdBytes(HeldNrrd nrrd) : nrrd_(std::move(nrrd)) {}
  const std::byte* data() const override { return static_cast<const std::byte*>(nrrd_->data); }

 private:
  HeldNrrd nrrd_;
};

template <class Use>
void with_type_of(const Nrrd& nrrd, const Use& use) {
  const bool real = nrrd.type == nrrdTypeFloat || nrrd.type == nrrdTypeDouble;
  const bool is_signed =
      nrrd.type == nrrdTypeChar || nrrd.type == nrrdTypeShort || nrrd.type == nrrdTypeInt || nrrd.type == nrrdTypeLLong;
  with_number_type(real, is_signed, int(nrrdElementSize(&nrrd)), use);
}

/// Leaves the values in their file, if they lie there as they are. False where they do not.
bool map_values(Volume& volume, const Nrrd& header, const NrrdEncoded& encoded, const NrrdStorage& storage,
                const fs::path& path) {
  const std::size_t size = nrrdElementSize(&header), offset = storage.files.empty() ? storage.header_bytes : 0;
  const bool as_it_is = encoded.encoding == nrrdEncodingRaw && !encoded.skips && !(encoded.swapped && size > 1);
  if (!as_it_is || storage.files.size() > 1 || !can_map(Values::mapped, offset, volume.voxels(), size)) return false;
  with_type_of(header, [&](auto zero) {
    const fs::path& file = storage.files.empty() ? path : storage.files[0];
    volume.values = mapped_values<decltype(zero)>(file, offset, volume.voxels());
  });
  return true;
}

void set_values(Volume& volume, HeldNrrd held, const NrrdAxes& axes, int layer, const std::vector<Segment>& segments) {
  const Nrrd& nrrd = *held;
  const NrrdIndex index_of(nrrd, axes);
  with_type_of(nrrd, [&](auto zero) {
    using T = decltype(zero);
    const T* from = static_cast<const T*>(nrrd.data);
    if (!axes.layers) {
      volume.values = VoxelArray<T>(std::make_shared<NrrdBytes>(std::move(held)), volume.voxels());
    } else if (layer >= 0) {
      volume.values = copied_values(volume, from, index_of, std::size_t(layer));
    } else {
      merge_layers(volume, std::int64_t(nrrd.axis[*axes.layers].size), segments,
                   [&](std::size_t voxel, std::int64_t l) {
                     const T value = from[index_of(voxel, std::size_t(l))];
                     if constexpr (std::is_floating_point_v<T>)
                       return std::abs(value) < T(1e15) ? std::int64_t(value) : std::int64_t(0);
                     else
                       return std::int64_t(value);
                   });
    }
  });
}

Volume open_nrrd(const fs::path& path, int layer, Values how) {
  static std::mutex one_at_a_time;  // teem has only one list of messages
  const std::lock_guard lock(one_at_a_time);
  const NrrdStorage storage = look_into_nrrd(path);
  NrrdEncoded encoded;
  const auto header = load(path, true, &encoded);
  if (header->type <= nrrdTypeUnknown || header->type >= nrrdTypeBlock)
    fail_reading(path, "its values are blocks of bytes, not numbers", "convert it to a numeric type");
  if (header->spaceDim != 0 && header->spaceDim != 3 && header->spaceDim != 4)
    fail_reading(path, fmt::format("its space has {} dimensions", header->spaceDim), "open a volume");
  const NrrdAxes axes = find_axes(*header, path);

  Volume volume;
  const std::size_t bytes_per_voxel = nrrdElementSize(header.get());
  std::array<std::int64_t, 3> dims{};
  for (int i = 0; i < 3; ++i)
    dims[i] = std::int64_t(std::min<std::size_t>(header->axis[axes.spatial[std::size_t(i)]].size, INT64_MAX));
  const std::vector<Segment> segments = find_segments([&](const std::string& key) -> std::optional<std::string> {
    const std::unique_ptr<char, Delete> value(nrrdKeyValueGet(header.get(), key.c_str()));
    if (!value) return {};
    return value.get();
  });
  check_layers(*header, axes, !segments.empty(), layer, path);
  const std::size_t layers = axes.layers ? header->axis[*axes.layers].size : 1;
  if (layers > most_layers) fail_reading(path, fmt::format("it has {} layers", with_commas(layers)));
  set_dims(volume, dims, bytes_per_voxel * layers, path);
  set_orientation(volume, *header, axes.spatial, path);
  LabelTable labels = table_of_segments(segments, std::max(layer, 0));
  volume.label_names = std::move(labels.names);
  volume.label_colours = std::move(labels.colours);
  if (header->spaceDim > 0 && header->spaceUnits[0]) volume.unit = header->spaceUnits[0];
  const std::size_t numbers = volume.voxels() * layers;
  check_stored(storage.bytes, numbers * bytes_per_voxel, ratio_of(encoded.encoding, bytes_per_voxel), path);
  check_encoding(volume, encoded, storage, numbers * bytes_per_voxel, path);

  if (how == Values::mapped && !axes.layers && map_values(volume, *header, encoded, storage, path)) return volume;
  auto nrrd = load(path, false);
  if (!nrrd->data || nrrdElementNumber(nrrd.get()) != numbers) fail_reading(path, "it changed while it was read");
  set_values(volume, std::move(nrrd), axes, layer, segments);
  return volume;
}

}  // namespace

Volume read_nrrd_layer(const fs::path& path, int layer) { return open_nrrd(path, layer, Values::read); }
Volume map_nrrd(const fs::path& path) { return open_nrrd(path, all_layers, Values::mapped); }

Volume read_nrrd(const fs::path& path) { return read_nrrd_layer(path, all_layers); }

}  // namespace nacre
