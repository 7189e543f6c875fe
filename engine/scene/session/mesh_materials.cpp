// Nacre: materials of volumes as a mesh run and its report need them, and what is wrong with a mesh.
#include "engine/scene/session/mesh_materials.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/volume/material_options.hpp"

namespace nacre {
namespace {

constexpr const char* smaller_sizes = "smaller --min-size and --max-size";

/// The first twelve entries of a list.
std::string some_of(const std::vector<std::int64_t>& labels) {
  const std::size_t shown = std::min<std::size_t>(labels.size(), 12);
  return fmt::format("{}{}", fmt::join(labels.begin(), labels.begin() + std::ptrdiff_t(shown), ", "),
                     shown < labels.size() ? ", ..." : "");
}

/// The conditions of TopologyReport::sound() that are not met, with counts.
std::string defects_of(const TopologyReport& t) {
  std::vector<std::string> found;
  const auto count = [&](std::int64_t n, const char* one, const char* many) {
    if (n > 0) found.push_back(fmt::format("{} {}", n, n == 1 ? one : many));
  };
  count(t.boundary_edges, "boundary edge", "boundary edges");
  count(t.nonmanifold_edges, "non-manifold edge", "non-manifold edges");
  count(t.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices");
  count(t.inconsistent_edges, "edge with facets turned against each other",
        "edges with facets turned against each other");
  count(t.duplicate_triangles, "duplicate triangle", "duplicate triangles");
  count(t.degenerate_triangles, "triangle without area", "triangles without area");
  return fmt::format("{}", fmt::join(found, ", "));
}

}  // namespace

MeshVolume make_materials(const std::vector<Volume>& volumes, bool sample, const MaterialSettings& settings,
                          MeshInput& described, const WarningSink& warn) {
  MaterialOptions options = parse_material_settings(settings);
  const bool scalar_sample = sample && !volume_statistics(volumes.front()).integral;
  if (scalar_sample && options.mode == MaterialOptions::Mode::automatic && !options.threshold)
    options.isovalues = {phantom_isovalue};
  described = {};
  for (const Volume& volume : volumes)
    described.warnings.insert(described.warnings.end(), volume.warnings.begin(), volume.warnings.end());
  const std::size_t said = described.warnings.size();
  MeshVolume volume = make_mesh_volume(volumes, options, &described.warnings);
  if (warn)
    for (std::size_t i = said; i < described.warnings.size(); ++i) warn(described.warnings[i]);
  described.name = volumes.front().name;
  for (std::size_t i = 1; i < volumes.size(); ++i) described.name += ", " + volumes[i].name;
  described.kind = volume.kind;
  described.dims = volume.dims;
  described.spacing = volume.spacing;
  described.origin = volume.origin;
  described.axes = volume.axes;
  described.labels = volume.labels;
  described.names = volume.names;
  described.unit = volumes.front().unit;
  const LabelColours& colours = volumes.front().label_colours;
  described.colours.assign(volume.labels.size(), std::nullopt);
  for (std::size_t m = 1; m < volume.labels.size(); ++m)
    if (const auto own = colours.find(volume.labels[m]);
        own != colours.end() && volume.kind == MeshVolume::Kind::labels)
      described.colours[m] = own->second;
  const std::vector<std::int64_t> voxels = volume.material.counts(volume.materials());
  described.voxels.assign(voxels.begin(), voxels.end());
  return volume;
}

EdgeLength longest_edge(double max_cell, const Vec3d& spacing) {
  if (max_cell <= 0) return {};
  const float longest = float(max_cell * std::min({spacing.x, spacing.y, spacing.z}));
  return [longest](std::span<const Vec3d> points) { return std::vector<float>(points.size(), longest); };
}

std::vector<std::int64_t> lost_labels(std::span<const std::int64_t> labels, const TopologyReport& topology) {
  std::vector<std::int64_t> lost;
  for (std::size_t m = 1; m < topology.materials.size(); ++m)
    if (topology.materials[m].facets == 0) lost.push_back(labels[m]);
  return lost;
}

std::vector<std::string> mesh_flaws(std::span<const std::int64_t> labels, const TopologyReport& topology) {
  std::vector<std::string> flaws;
  const std::vector<std::int64_t> lost = lost_labels(labels, topology);
  if (lost.size() == 1)
    flaws.push_back(fmt::format("label {} was lost: it has no surface; {}, or a smaller --tighten, may keep it",
                                lost[0], smaller_sizes));
  if (lost.size() > 1)
    flaws.push_back(
        fmt::format("{} labels were lost: they have no surface ({}); {}, or a smaller --tighten, may keep them",
                    lost.size(), some_of(lost), smaller_sizes));
  std::vector<std::int64_t> open;
  for (std::size_t m = 1; m < topology.materials.size(); ++m)
    if (topology.materials[m].facets > 0 && !topology.materials[m].closed) open.push_back(labels[m]);
  if (!open.empty()) flaws.push_back(fmt::format("the surface of label {} is not closed", some_of(open)));
  if (const std::string defects = defects_of(topology); !defects.empty())
    flaws.push_back(fmt::format("the mesh is not sound: {}; {} may help", defects, smaller_sizes));
  return flaws;
}

}  // namespace nacre
