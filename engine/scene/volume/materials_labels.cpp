// Nacre: materials of a label map.
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <unordered_map>

#include "compute/device/error.hpp"
#include "engine/scene/volume/materials_parts.hpp"

namespace nacre::materials {
namespace {

constexpr std::size_t most_materials = 65535;
constexpr std::size_t listed = 40;

std::string list_of(const std::vector<std::int64_t>& labels) {
  const std::size_t shown = std::min(labels.size(), listed);
  const std::span<const std::int64_t> first(labels.data(), shown);
  return fmt::format("{}{}", fmt::join(first, ", "), shown < labels.size() ? ", ..." : "");
}

void require_label(const std::vector<std::int64_t>& present, std::int64_t label, const std::string& name) {
  if (!std::binary_search(present.begin(), present.end(), label))
    throw Error(fmt::format("{} has no label {}", name, label), fmt::format("there are {}", list_of(present)),
                "choose among these");
}

[[noreturn]] void fail_no_labels(const Volume& volume) {
  const VolumeStatistics statistics = volume_statistics(volume);
  const std::string range = fmt::format("its values run from {:.6g} to {:.6g}", statistics.min, statistics.max);
  throw Error(fmt::format("{} is not a label map", volume.name),
              statistics.integral ? range + fmt::format(", with more than {} different ones", most_materials)
                                  : range + " and are not all whole numbers",
              fmt::format("give --isovalue V, for example {:.6g}", otsu_threshold(volume)));
}

using MaterialOfLabel = std::unordered_map<std::int64_t, std::uint16_t>;

/// Labels of one or two bytes stay where they are.
template <class T>
requires(sizeof(T) <= 2) MaterialArray
    materials_of(const VoxelArray<T>& values, const MaterialOfLabel& of, const std::vector<LabelCount>& counts) {
  std::vector<std::uint16_t> table(std::size_t(1) << 8 * sizeof(T), 0);
  std::vector<std::int64_t> voxels;
  for (const auto& [label, count] : counts) {
    const std::uint16_t material = of.at(label);
    table[std::make_unsigned_t<T>(label)] = material;
    voxels.resize(std::max<std::size_t>(voxels.size(), material + 1u), 0);
    voxels[material] += std::int64_t(count);
  }
  return {values.held(), int(sizeof(T)), values.size(), std::move(table), std::move(voxels)};
}

/// Material per voxel; what is no number is outside.
template <class T>
requires(sizeof(T) > 2) MaterialArray
    materials_of(const VoxelArray<T>& values, const MaterialOfLabel& of, const std::vector<LabelCount>&) {
  std::vector<std::uint16_t> result(values.size());
  for (std::size_t i = 0; i < values.size();) {
    const T value = values[i];
    std::size_t end = i + 1;
    while (end < values.size() && values[end] == value) ++end;
    bool finite = true;
    if constexpr (std::is_floating_point_v<T>) finite = std::isfinite(value);
    const auto found = finite ? of.find(std::int64_t(value)) : of.end();
    std::fill(result.begin() + std::ptrdiff_t(i), result.begin() + std::ptrdiff_t(end),
              found == of.end() ? std::uint16_t(0) : found->second);
    i = end;
  }
  return result;
}

/// Per material; nothing where the file names none of them.
std::vector<std::string> names_of(const std::vector<std::int64_t>& labels, const LabelNames& given) {
  std::vector<std::string> names(labels.size());
  bool any = false;
  for (std::size_t m = 1; m < labels.size(); ++m)
    if (const auto found = given.find(labels[m]); found != given.end()) names[m] = found->second, any = true;
  if (!any) return {};
  names[0] = "outside";
  return names;
}

}  // namespace

LabelPlan::LabelPlan(const std::vector<std::int64_t>& present, const MaterialOptions& options, const std::string& name)
    : merge_(options.merge) {
  for (const auto& [from, to] : merge_) {
    require_label(present, from, name);
    for (const auto& [other, target] : merge_)
      if (other == from && target != to)
        throw Error(fmt::format("Label {} cannot be merged into two others", from),
                    fmt::format("{} and {}", to, target), "give one of them");
  }
  std::vector<std::int64_t> kept;
  for (const std::int64_t label : present) kept.push_back(merged(label));
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (const std::int64_t label : options.materials) require_label(kept, label, name);
  const auto chosen = [&](std::int64_t label) {
    const auto& wanted = options.materials;
    return wanted.empty() ? label != 0 : std::find(wanted.begin(), wanted.end(), label) != wanted.end();
  };
  const std::int64_t smallest = kept.empty() ? 0 : kept.front();
  std::erase_if(kept, [&](std::int64_t label) { return !chosen(label); });
  const bool zero_inside = std::find(kept.begin(), kept.end(), 0) != kept.end();
  labels_.push_back(zero_inside ? smallest - 1 : 0);
  labels_.insert(labels_.end(), kept.begin(), kept.end());
}

std::int64_t LabelPlan::merged(std::int64_t label) const {
  for (const auto& [from, to] : merge_)
    if (from == label) return to;
  return label;
}

std::uint16_t LabelPlan::material(std::int64_t label) const {
  const auto first = labels_.begin() + 1;
  const auto found = std::lower_bound(first, labels_.end(), merged(label));
  return found != labels_.end() && *found == merged(label) ? std::uint16_t(found - labels_.begin()) : std::uint16_t(0);
}

MeshVolume from_labels(const Volume& volume, const MaterialOptions& options, const Notes& notes) {
  const auto counts = count_labels(volume, most_materials);
  if (!counts) fail_no_labels(volume);
  const VolumeStatistics statistics = volume_statistics(volume);
  if (statistics.nan + statistics.infinite > 0)
    notes.add(fmt::format("{}: {} voxels that are not numbers became outside.", volume.name,
                          statistics.nan + statistics.infinite));
  std::vector<std::int64_t> present;
  for (const auto& [label, voxels] : *counts) present.push_back(label);
  if (present.empty())
    throw Error(fmt::format("{} has nothing to mesh", volume.name), "none of its voxels is a number", "check the file");
  if (present.size() == 1 && statistics.nan + statistics.infinite == 0)
    throw Error(fmt::format("{} has one material only", volume.name), fmt::format("every voxel is {}", present[0]),
                "open a volume with a boundary in it");

  const LabelPlan plan(present, options, volume.name);
  if (plan.labels().size() < 2)
    throw Error(fmt::format("{} has nothing to mesh", volume.name), "no label but the outside is left",
                fmt::format("choose among {}", list_of(present)));
  MaterialOfLabel of;
  for (const std::int64_t label : present) of[label] = plan.material(label);
  MeshVolume result = on_grid_of(volume, MeshVolume::Kind::labels);
  result.labels = plan.labels();
  result.names = names_of(result.labels, volume.label_names);
  result.material = std::visit([&](const auto& values) { return materials_of(values, of, *counts); }, volume.values);
  return result;
}

}  // namespace nacre::materials
