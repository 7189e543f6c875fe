// Nacre: what the values of a volume are like.
#include "engine/scene/volume/volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <unordered_map>

namespace nacre {
namespace {

constexpr double largest_label = 9007199254740992.0;  // 2^53: beyond, doubles cannot represent every integer

template <class T>
bool is_label(T value) {
  if constexpr (std::is_floating_point_v<T>)
    return std::abs(value) <= T(largest_label) && value == std::floor(value);
  else if constexpr (sizeof(T) == 8)
    return double(value) <= largest_label && double(value) >= -largest_label;
  else
    return true;
}

template <class T>
VolumeStatistics statistics_of(const VoxelArray<T>& values) {
  VolumeStatistics result;
  T low = std::numeric_limits<T>::max(), high = std::numeric_limits<T>::lowest();
  bool integral = true, any = false;
  for (const T value : values) {
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) {
        ++(std::isnan(value) ? result.nan : result.infinite);
        continue;
      }
    low = std::min(low, value);
    high = std::max(high, value);
    integral = integral && is_label(value);
    any = true;
  }
  if (!any) return result;
  result.min = double(low);
  result.max = double(high);
  result.integral = integral;
  return result;
}

template <class T>
std::optional<std::vector<LabelCount>> labels_of(const VoxelArray<T>& values, std::size_t most) {
  std::unordered_map<std::int64_t, std::size_t> counts;
  // Neighbours are mostly equal: look up once per run of equal values.
  for (std::size_t i = 0; i < values.size();) {
    const T value = values[i];
    std::size_t end = i + 1;
    while (end < values.size() && values[end] == value) ++end;
    bool finite = true;
    if constexpr (std::is_floating_point_v<T>) finite = std::isfinite(value);
    if (finite) {
      if (!is_label(value)) return {};
      counts[std::int64_t(value)] += end - i;
      if (counts.size() > most) return {};
    }
    i = end;
  }
  std::vector<LabelCount> sorted(counts.begin(), counts.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The values of one or two bytes that occur, ascending.
template <class T>
std::vector<LabelCount> labels_in(const ValueCounts& counts) {
  std::vector<LabelCount> labels;
  for (int value = std::numeric_limits<T>::lowest(); value <= std::numeric_limits<T>::max(); ++value)
    if (const std::size_t n = counts.voxels[std::make_unsigned_t<T>(value)]; n > 0) labels.push_back({value, n});
  return labels;
}

}  // namespace

const char* value_type_name(const VolumeValues& values) {
  constexpr const char* names[] = {"uint8", "int8",   "uint16", "int16", "uint32",
                                   "int32", "uint64", "int64",  "float", "double"};
  static_assert(std::size(names) == std::variant_size_v<VolumeValues>);
  return names[values.index()];
}

VolumeStatistics volume_statistics(const Volume& volume) {
  const ValueCounts* counts = value_counts(volume);
  return std::visit(
      [&]<class T>(const VoxelArray<T>& values) -> VolumeStatistics {
        if constexpr (sizeof(T) <= 2) {
          const std::vector<LabelCount> labels = labels_in<T>(*counts);
          if (labels.empty()) return {};
          return {double(labels.front().first), double(labels.back().first), 0, 0, true};
        } else {
          return statistics_of(values);
        }
      },
      volume.values);
}

std::optional<std::vector<LabelCount>> count_labels(const Volume& volume, std::size_t most) {
  const ValueCounts* counts = value_counts(volume);
  return std::visit(
      [&]<class T>(const VoxelArray<T>& values) -> std::optional<std::vector<LabelCount>> {
        if constexpr (sizeof(T) <= 2) {
          std::vector<LabelCount> labels = labels_in<T>(*counts);
          if (labels.size() > most) return {};
          return labels;
        } else {
          return labels_of(values, most);
        }
      },
      volume.values);
}

}  // namespace nacre
