// Nacre: materials of a scalar volume: between iso-values, or by a threshold.
#include <algorithm>

#include "compute/device/error.hpp"
#include "engine/scene/volume/materials_parts.hpp"

namespace nacre::materials {
namespace {

/// Throws Error where there is no surface to find in a volume.
VolumeStatistics checked_statistics(const Volume& volume, const Notes& notes) {
  const VolumeStatistics statistics = volume_statistics(volume);
  if (statistics.nan + statistics.infinite == volume.voxels())
    throw Error(fmt::format("{} has nothing to mesh", volume.name), "none of its voxels is a number", "check the file");
  if (statistics.min == statistics.max && statistics.nan == 0)
    throw Error(fmt::format("{} has one value only", volume.name), fmt::format("every voxel is {:.6g}", statistics.min),
                "open a volume with a boundary in it");
  note_not_finite(volume, statistics, notes);
  return statistics;
}

std::string range_of(const VolumeStatistics& statistics) {
  return fmt::format("the values run from {:.6g} to {:.6g}", statistics.min, statistics.max);
}

void check_level(const Volume& volume, const VolumeStatistics& statistics, double level) {
  if (!std::isfinite(level)) throw Error("an iso-value is not a number", "", "give --isovalue V");
  const bool all_inside = level <= statistics.min && statistics.nan == 0;
  if (level > statistics.max || all_inside)
    throw Error(fmt::format("{} has no surface at iso-value {:.6g}", volume.name, level), range_of(statistics),
                fmt::format("give a value between, for example {:.6g}", otsu_threshold(volume)));
}

}  // namespace

MeshVolume from_isovalues(const Volume& volume, const MaterialOptions& options, const Notes& notes) {
  const VolumeStatistics statistics = checked_statistics(volume, notes);
  std::vector<double> levels = options.isovalues;
  std::sort(levels.begin(), levels.end());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    check_level(volume, statistics, levels[i]);
    if (i > 0 && float(levels[i]) == float(levels[i - 1]))
      throw Error(fmt::format("iso-value {:.6g} was given twice", levels[i]), "", "give each once");
  }
  if (levels.size() > 65534) throw Error("too many iso-values were given", "", "give fewer than 65535");

  MeshVolume result = on_grid_of(volume, MeshVolume::Kind::scalar);
  result.levels.assign(levels.begin(), levels.end());
  // As far below the lowest level as the values reach above it, so that the surface around such a hole is not moved.
  const double below = std::min(statistics.min, 2 * levels[0] - statistics.max);
  result.values.push_back(as_floats(volume, statistics, float(below)));
  const std::vector<float>& values = result.values[0];
  std::vector<std::uint16_t> material(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    material[i] =
        std::uint16_t(std::upper_bound(result.levels.begin(), result.levels.end(), values[i]) - result.levels.begin());
  result.material = std::move(material);
  for (std::size_t m = 0; m <= levels.size(); ++m) result.labels.push_back(std::int64_t(m));
  return result;
}

MeshVolume from_threshold(const Volume& volume, const MaterialOptions& options, const Notes& notes) {
  const VolumeStatistics statistics = checked_statistics(volume, notes);
  const auto [lowest, highest] = *options.threshold;
  if (!(lowest < highest) && !(statistics.integral && lowest == highest))
    throw Error(fmt::format("the threshold {:.6g}:{:.6g} is empty", lowest, highest), "",
                "give the lowest and the highest value, LOW:HIGH");
  const std::string what =
      fmt::format("{} has no surface at the threshold {:.6g}:{:.6g}", volume.name, lowest, highest);
  if (lowest <= statistics.min && highest >= statistics.max && statistics.nan == 0)
    throw Error(what, "every voxel is inside, " + range_of(statistics), "give a smaller range");

  MeshVolume result = on_grid_of(volume, MeshVolume::Kind::indicators);
  result.labels = {0, 1};
  // Whole values on the bounds are inside. A bound that no value reaches does not limit; a value that is not a number
  // counts as outside, as far as the range is wide.
  const double half = statistics.integral && lowest == std::floor(lowest) && highest == std::floor(highest) ? 0.5 : 0;
  const double low = std::max(lowest - half, statistics.min - (statistics.max - statistics.min) - 1);
  const double high = std::min(highest + half, statistics.max + (statistics.max - statistics.min) + 1);
  const float nowhere = float(low - (high - low));
  std::vector<float> inside = as_floats(volume, statistics, nowhere), outside(inside.size());
  std::vector<std::uint16_t> material(inside.size());
  bool any = false;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    inside[i] = std::min(inside[i] - float(low), float(high) - inside[i]);
    outside[i] = -inside[i];
    material[i] = inside[i] > 0;
    any = any || inside[i] > 0;
  }
  if (!any) throw Error(what, "no voxel is inside, " + range_of(statistics), "give another range");
  result.material = std::move(material);
  result.values = {std::move(outside), std::move(inside)};
  return result;
}

}  // namespace nacre::materials
