// Nacre: how a volume becomes materials.
#include "engine/scene/volume/materials.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "compute/device/error.hpp"
#include "engine/scene/volume/materials_parts.hpp"

namespace nacre {
namespace {

using namespace materials;
using Mode = MaterialOptions::Mode;

constexpr std::size_t most_automatic_labels = 256;
constexpr std::size_t many_labels = 100;
constexpr std::size_t few_labels = 32;  // as many values are labels, however they lie
constexpr double least_alike = 0.6;  // of neighbours in a label map; of real ones 0.77 and more, of images 0.5 and less

void check_options(std::span<const Volume> volumes, const MaterialOptions& options) {
  const bool scalar = options.mode == Mode::isovalue || !options.isovalues.empty() || options.threshold;
  const std::string what = "The options for materials contradict each other";
  if (volumes.empty()) throw Error("no volume is given", "", "name at least one");
  if (!options.isovalues.empty() && options.threshold)
    throw Error(what, "iso-values and a threshold were given", "leave one of them out");
  if (options.mode == Mode::isovalue && options.isovalues.empty() && !options.threshold)
    throw Error(what, "no iso-value was given", "give --isovalue V");
  if (options.mode == Mode::labels && scalar)
    throw Error(what, "labels and iso-values were asked for", "leave one of them out");
  if (scalar && volumes.size() > 1) throw Error(what, "an iso-value cuts one volume, several were given", "name one");
  if (options.mode == Mode::labels && volumes.size() > 1)
    throw Error(what, "labels come from one volume, several were given", "name one");
  if (scalar && (!options.materials.empty() || !options.merge.empty()))
    throw Error(what, "materials can be chosen and merged in label maps and indicators", "leave that out");
  if (options.min_component < 0) throw Error(what, "a component cannot have fewer than 0 voxels", "give 0 or more");
}

/// Share of neighbours along x with the same value, of those that are not both `usual`. Labels lie in patches; an
/// image's values change from voxel to voxel.
double share_alike(const Volume& volume, double usual) {
  std::size_t alike = 0, all = 0;
  if (const ValueCounts* counts = value_counts(volume)) {
    for (const std::size_t n : counts->repeated) alike += n;
    const auto bits = std::int64_t(usual) & std::int64_t(counts->repeated.size() - 1);
    const std::size_t both_usual = counts->repeated[std::size_t(bits)];
    all = volume.voxels() - volume.voxels() / std::size_t(volume.dims.x) - both_usual;
    return all > 0 ? double(alike - both_usual) / double(all) : 1;
  }
  std::visit(
      [&](const auto& values) {
        const std::size_t row = std::size_t(volume.dims.x);
        for (std::size_t i = 1; i < values.size(); ++i) {
          if (i % row == 0 || (double(values[i]) == usual && double(values[i - 1]) == usual)) continue;
          ++all;
          alike += values[i] == values[i - 1];
        }
      },
      volume.values);
  return all > 0 ? double(alike) / double(all) : 1;
}

/// A single volume without iso-value or threshold: labels where it looks like that.
bool looks_like_labels(const Volume& volume, const Notes& notes) {
  const auto labels = count_labels(volume, most_automatic_labels);
  if (!labels) return false;
  const auto most = std::max_element(labels->begin(), labels->end(),
                                     [](const LabelCount& a, const LabelCount& b) { return a.second < b.second; });
  if (labels->size() > few_labels && share_alike(volume, double(most->first)) < least_alike) return false;
  if (labels->size() > many_labels)
    notes.add(fmt::format(
        "{} has {} different values, taken for labels; if it is an image, give --isovalue (for example {:.6g}).",
        volume.name, labels->size(), otsu_threshold(volume)));
  return true;
}

[[noreturn]] void fail_without_isovalue(const Volume& volume) {
  const VolumeStatistics statistics = volume_statistics(volume);
  throw MissingIsovalue(volume.name,
                        fmt::format("its values, {:.6g} to {:.6g}, are not labels", statistics.min, statistics.max),
                        otsu_threshold(volume), statistics.integral ? ", or --labels if they are labels" : "");
}

void check_inside(const MeshVolume& volume, const std::string& name, const char* advice) {
  if (volume.materials() < 2 || volume.material.all_outside())
    throw Error(fmt::format("{} has nothing to mesh", name), "no voxel is inside a material", advice);
}

}  // namespace

namespace materials {

MeshVolume on_grid_of(const Volume& volume, MeshVolume::Kind kind) {
  MeshVolume result;
  result.kind = kind;
  result.dims = volume.dims;
  result.spacing = volume.spacing;
  result.origin = volume.origin;
  result.axes = volume.axes;
  return result;
}

std::vector<float> as_floats(const Volume& volume, const VolumeStatistics& statistics, float otherwise) {
  return std::visit(
      [&](const auto& values) {
        std::vector<float> floats(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          if constexpr (std::is_floating_point_v<std::decay_t<decltype(values[0])>>) {
            if (!std::isfinite(values[i])) {
              floats[i] = std::isnan(values[i]) ? otherwise : float(values[i] > 0 ? statistics.max : statistics.min);
              continue;
            }
          }
          floats[i] = float(values[i]);
        }
        return floats;
      },
      volume.values);
}

void note_not_finite(const Volume& volume, const VolumeStatistics& statistics, const Notes& notes) {
  if (statistics.nan > 0)
    notes.add(fmt::format("{}: {} voxels that are not numbers became outside.", volume.name, statistics.nan));
  if (statistics.infinite > 0)
    notes.add(fmt::format("{}: {} infinite voxels took the nearest finite value.", volume.name, statistics.infinite));
}

}  // namespace materials

double otsu_threshold(const Volume& volume) {
  const VolumeStatistics statistics = volume_statistics(volume);
  constexpr int bins = 256;
  const double width = (statistics.max - statistics.min) / bins;
  if (!(width > 0)) return statistics.min;
  std::array<double, bins> counts{};
  std::visit(
      [&](const auto& values) {
        for (const auto value : values)
          if (const double at = (double(value) - statistics.min) / width; at >= 0 && at <= bins)
            ++counts[std::size_t(std::min(int(at), bins - 1))];
      },
      volume.values);
  double all = 0, weighted = 0;
  for (int b = 0; b < bins; ++b) {
    all += counts[b];
    weighted += b * counts[b];
  }
  double below = 0, below_weighted = 0, best = -1;
  int first = 0, last = 0;  // of the cuts that are as good: all those within a gap
  for (int b = 0; b + 1 < bins; ++b) {
    below += counts[b];
    below_weighted += b * counts[b];
    if (below == 0 || below == all) continue;
    const double difference = below_weighted / below - (weighted - below_weighted) / (all - below);
    const double between = below * (all - below) * difference * difference;
    if (between > best) {
      best = between;
      first = b;
    }
    if (between == best) last = b;
  }
  return statistics.min + (0.5 * (first + last) + 1) * width;
}

MissingIsovalue::MissingIsovalue(const std::string& name, const std::string& why, double proposal,
                                 const std::string& otherwise)
    : Error(fmt::format("{} needs an iso-value", name), why,
            fmt::format("give --isovalue V, for example {:.6g}{}", proposal, otherwise)),
      proposal_(proposal) {}

MeshVolume make_mesh_volume(std::span<const Volume> volumes, const MaterialOptions& options,
                            std::vector<std::string>* warnings) {
  check_options(volumes, options);
  const Notes notes{warnings};
  const Volume& first = volumes[0];
  MeshVolume result;
  if (volumes.size() > 1)
    result = from_indicators(volumes, options, notes);
  else if (options.threshold)
    result = from_threshold(first, options, notes);
  else if (!options.isovalues.empty())
    result = from_isovalues(first, options, notes);
  else if (options.mode == Mode::labels || looks_like_labels(first, notes))
    result = from_labels(first, options, notes);
  else
    fail_without_isovalue(first);
  if (options.min_component > 1) drop_small_components(result, options.min_component, notes);
  check_inside(result, first.name, options.min_component > 1 ? "lower --min-component" : "choose other materials");
  return result;
}

}  // namespace nacre
