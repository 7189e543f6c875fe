// Nacre: materials of several volumes, one indicator function each.
#include <algorithm>
#include <filesystem>
#include <limits>

#include "compute/device/error.hpp"
#include "engine/scene/volume/materials_parts.hpp"

namespace nacre::materials {
namespace {

constexpr double same = 1e-3;  // of a voxel, over the whole volume

std::string stem_of(const std::string& name) {
  const std::filesystem::path path(name);
  return path.extension() == ".gz" ? path.stem().stem().string() : path.stem().string();
}

/// What differs between two grids; empty where nothing does.
std::string difference(const Volume& a, const Volume& b) {
  if (!(a.dims == b.dims))
    return fmt::format("{} x {} x {} voxels and {} x {} x {}", a.dims.x, a.dims.y, a.dims.z, b.dims.x, b.dims.y,
                       b.dims.z);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(a.spacing[axis] - b.spacing[axis]) * a.dims[axis] > same * a.spacing[axis])
      return fmt::format("spacing {:.6g} and {:.6g} along axis {}", a.spacing[axis], b.spacing[axis], axis);
    if (length(a.axes[axis] - b.axes[axis]) * a.dims[axis] > same)
      return fmt::format("axis {} points to different directions", axis);
    if (std::abs(dot(a.origin - b.origin, a.axes[axis])) > same * a.spacing[axis])
      return fmt::format("origins ({:.6g} {:.6g} {:.6g}) and ({:.6g} {:.6g} {:.6g})", a.origin.x, a.origin.y,
                         a.origin.z, b.origin.x, b.origin.y, b.origin.z);
  }
  return {};
}

void check_grids(std::span<const Volume> volumes) {
  for (const Volume& volume : volumes.subspan(1))
    if (const std::string why = difference(volumes[0], volume); !why.empty())
      throw Error(fmt::format("{} and {} are not on the same grid", volumes[0].name, volume.name), why,
                  "resample them to one");
}

/// What all indicators have in common.
struct Range {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  bool real = false;  ///< one of them is stored as floats
};

Range range_of(std::span<const Volume> volumes, const Notes& notes) {
  Range range;
  for (const Volume& volume : volumes) {
    const VolumeStatistics statistics = volume_statistics(volume);
    if (statistics.nan + statistics.infinite == volume.voxels())
      throw Error(fmt::format("{} has nothing to mesh", volume.name), "none of its voxels is a number",
                  "check the file");
    note_not_finite(volume, statistics, notes);
    range.min = std::min(range.min, statistics.min);
    range.max = std::max(range.max, statistics.max);
    range.real = range.real || std::holds_alternative<VoxelArray<float>>(volume.values) ||
                 std::holds_alternative<VoxelArray<double>>(volume.values);
  }
  if (range.min == range.max)
    throw Error("The indicator volumes have one value only", fmt::format("every voxel is {:.6g}", range.min),
                "open volumes with a boundary in them");
  return range;
}

/// Indicators that become the same material add up (probabilities) or take the larger (functions).
void add_to(std::vector<float>& sum, const std::vector<float>& values, bool functions) {
  if (sum.empty()) {
    sum = values;
    return;
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = functions ? std::max(sum[i], values[i]) : sum[i] + values[i];
}

/// The outside of probabilities: what is missing from 1.
void fill_rest(MeshVolume& volume) {
  std::vector<float>& rest = volume.values[0];
  rest.assign(volume.voxels(), 1.0f);
  for (std::size_t m = 1; m < volume.values.size(); ++m)
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= volume.values[m][i];
  for (float& value : rest) value = std::max(value, 0.0f);
}

std::vector<std::uint16_t> largest_of(const MeshVolume& volume) {
  std::vector<std::uint16_t> material(volume.voxels(), 0);
  std::vector<float> best = volume.values[0];
  for (std::size_t m = 1; m < volume.values.size(); ++m)
    for (std::size_t i = 0; i < best.size(); ++i)
      if (volume.values[m][i] > best[i]) {
        best[i] = volume.values[m][i];
        material[i] = std::uint16_t(m);
      }
  return material;
}

void note_losers(const MeshVolume& volume, const Notes& notes) {
  std::vector<bool> wins(volume.labels.size(), false);
  for (const std::uint16_t material : volume.material.numbers()) wins[material] = true;
  for (std::size_t m = 1; m < wins.size(); ++m)
    if (!wins[m]) notes.add(fmt::format("{} is nowhere the largest: it has no voxel.", volume.names[m]));
}

}  // namespace

MeshVolume from_indicators(std::span<const Volume> volumes, const MaterialOptions& options, const Notes& notes) {
  if (volumes.size() > 65534) throw Error("too many indicator volumes were given", "", "give fewer than 65535");
  check_grids(volumes);
  const Range range = range_of(volumes, notes);
  const bool functions = range.min < 0;
  const double scale = functions || (range.real && range.max <= 1) ? 1.0 : 1.0 / range.max;
  std::vector<std::int64_t> present;
  for (std::size_t i = 0; i < volumes.size(); ++i) present.push_back(std::int64_t(i) + 1);
  const LabelPlan plan(present, options, "The list of indicator volumes");

  MeshVolume result = on_grid_of(volumes[0], MeshVolume::Kind::indicators);
  result.labels = plan.labels();
  result.values.resize(result.labels.size());
  result.names.assign(result.labels.size(), "outside");
  // What is no number must not win over anything.
  const float nowhere = functions ? float(range.min - (range.max - range.min)) : 0.0f;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const std::uint16_t m = plan.material(present[i]);
    if (m == 0 && !functions) continue;
    std::vector<float> values = as_floats(volumes[i], volume_statistics(volumes[i]), nowhere);
    if (scale != 1.0)
      for (float& value : values) value = float(value * scale);
    add_to(result.values[m], values, functions);
    if (m > 0 && (result.labels[m] == present[i] || result.names[m] == "outside"))
      result.names[m] = stem_of(volumes[i].name);
  }
  if (!functions)
    fill_rest(result);
  else if (result.values[0].empty())
    result.values[0].assign(result.voxels(), nowhere);
  result.material = largest_of(result);
  note_losers(result, notes);
  return result;
}

}  // namespace nacre::materials
