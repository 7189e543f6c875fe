// Nacre: values on a regular grid of voxels, in host memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compute/math/vec.hpp"
#include "engine/scene/volume/voxel_array.hpp"

namespace nacre {

/// One value per voxel, x fastest, in the type of the file: a byte per voxel stays a byte.
using VolumeValues =
    std::variant<VoxelArray<std::uint8_t>, VoxelArray<std::int8_t>, VoxelArray<std::uint16_t>, VoxelArray<std::int16_t>,
                 VoxelArray<std::uint32_t>, VoxelArray<std::int32_t>, VoxelArray<std::uint64_t>,
                 VoxelArray<std::int64_t>, VoxelArray<float>, VoxelArray<double>>;

/// What labels are called; those that are not in it have no name.
using LabelNames = std::map<std::int64_t, std::string>;
/// What colours labels have, encoded sRGB, 0..1; those that are not in it have none of their own.
using LabelColours = std::map<std::int64_t, std::array<float, 3>>;

/// A volume as its file has it, nothing flipped or resampled. Voxel (i, j, k) has its centre in the world at
/// origin + sum over a of axes[a] * (index[a] * spacing[a]). What the world's axes point to is the file's business:
/// right, anterior, superior (RAS) in NIfTI; what `space` says in NRRD; left, posterior, superior where MetaImage
/// follows ITK. Left-handed axes are kept.
struct Volume {
  std::string name;        ///< the file's name without folder
  std::string unit;        ///< of lengths: "mm", "m", "um"; empty where the file does not say
  std::string space;       ///< what x, y, z point to, "right-anterior-superior"; empty where the file does not say
  Int3 dims{};             ///< voxels along each axis, at least 2
  Vec3d spacing{1, 1, 1};  ///< > 0, the file's unit
  Vec3d origin{};          ///< of voxel (0, 0, 0)'s centre
  std::array<Vec3d, 3> axes{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};  ///< unit, orthogonal
  VolumeValues values;
  LabelNames label_names;             ///< if the file names its values
  LabelColours label_colours;         ///< and what colours they have
  std::vector<std::string> warnings;  ///< what was assumed on opening, each a full sentence

  std::size_t voxels() const { return std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z); }
  bool right_handed() const { return dot(cross(axes[0], axes[1]), axes[2]) > 0; }
};

/// "uint8", "int16", ..., "float", "double".
const char* value_type_name(const VolumeValues& values);

/// What the values are like.
struct VolumeStatistics {
  double min = 0, max = 0;   ///< of the finite values; 0 where there are none
  std::size_t nan = 0;       ///< voxels that are no number
  std::size_t infinite = 0;  ///< voxels that are plus or minus infinity
  bool integral = false;     ///< all finite values are whole and below 2^53 in size; there is at least one
};

VolumeStatistics volume_statistics(const Volume& volume);

/// How often each value of one or two bytes occurs; null for other types. Counted once.
const ValueCounts* value_counts(const Volume& volume);

/// A value and how many voxels have it.
using LabelCount = std::pair<std::int64_t, std::size_t>;

/// The different values of a volume whose finite values are integral, ascending; nothing where they are not, or where
/// there are more than `most`. Voxels that are not finite are left out.
std::optional<std::vector<LabelCount>> count_labels(const Volume& volume, std::size_t most);

}  // namespace nacre
