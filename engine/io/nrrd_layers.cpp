// Nacre: the overlapping layers of a segmentation.
#include "engine/io/nrrd_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <unordered_map>

#include "engine/io/build_surface.hpp"

namespace nacre {
namespace {

/// The label of each segment in the result; [0] is the outside.
std::vector<std::int64_t> labels_of_segments(Volume& volume, const std::vector<Segment>& segments) {
  std::vector<std::int64_t> labels{0};
  std::set<std::int64_t> different{0};
  for (const Segment& segment : segments) {
    labels.push_back(segment.label);
    different.insert(segment.label);
  }
  if (different.size() == labels.size()) return labels;
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = std::int64_t(i);
  volume.warnings.push_back(
      fmt::format("Segments of different layers have the same label value: they are numbered 1 to {} in their order.",
                  segments.size()));
  return labels;
}

template <class T>
std::vector<T> as_type(const std::vector<std::uint32_t>& ranks, const std::vector<std::int64_t>& labels) {
  std::vector<T> values(ranks.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) values[i] = T(labels[ranks[i]]);
  return values;
}

}  // namespace

void merge_layers(Volume& volume, std::int64_t layers, const std::vector<Segment>& segments,
                  const std::function<std::int64_t(std::size_t voxel, std::int64_t layer)>& value) {
  std::vector<std::unordered_map<std::int64_t, std::uint32_t>> rank_of(static_cast<std::size_t>(layers));
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (segments[i].layer >= 0 && segments[i].layer < layers && segments[i].label != 0)
      rank_of[std::size_t(segments[i].layer)][segments[i].label] = std::uint32_t(i + 1);
  std::vector<std::uint32_t> ranks(volume.voxels(), 0);
  std::size_t overlaps = 0;
  for (std::size_t voxel = 0; voxel < ranks.size(); ++voxel) {
    int found = 0;
    for (std::int64_t layer = 0; layer < layers; ++layer) {
      const std::int64_t here = value(voxel, layer);
      if (here == 0) continue;
      const auto& known = rank_of[std::size_t(layer)];
      const auto rank = known.find(here);
      if (rank == known.end()) continue;
      ranks[voxel] = std::max(ranks[voxel], rank->second);
      ++found;
    }
    overlaps += found > 1;
  }
  const std::vector<std::int64_t> labels = labels_of_segments(volume, segments);
  const auto [low, high] = std::minmax_element(labels.begin(), labels.end());
  if (*low >= 0 && *high <= std::numeric_limits<std::uint16_t>::max())
    volume.values = as_type<std::uint16_t>(ranks, labels);
  else
    volume.values = as_type<std::int64_t>(ranks, labels);
  volume.label_names.clear();
  volume.label_colours.clear();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!segments[i].name.empty()) volume.label_names.try_emplace(labels[i + 1], segments[i].name);
    if (segments[i].colour) volume.label_colours.try_emplace(labels[i + 1], *segments[i].colour);
  }
  if (overlaps > 0)
    volume.warnings.push_back(
        fmt::format("Its {} segments lie in {} layers and overlap in {} voxels, where the later segment counts; "
                    "--layer N takes one layer alone.",
                    segments.size(), layers, with_commas(overlaps)));
}

}  // namespace nacre
