// Nacre: long edges of bad triangles, split by new points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/defects.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// An edge that a point is to split: on the interface of two materials, or on the curve of three.
struct EdgeSplit {
  std::array<std::uint32_t, 2> ends;
  MeshDefects::NewPoint point;  ///< in the middle of the edge
};

/// The longest edges of the triangles that are bad by `rule`, where these are longer than 1.3 of the size at both ends.
/// No two edges share a triangle; those of the worst triangles come first. `size` (world units) is per point of the
/// mesh.
std::vector<EdgeSplit> edges_to_split(const SurfaceMesh& mesh, std::span<const std::uint8_t> order,
                                      std::span<const float> size, const DefectRule& rule);

/// Splits edge `splits[k]` by a point at `at[k]`, where the worst of the triangles is left more than half as good,
/// since other edits and smoothing can follow, and no surface turns by more than about 70 degrees. Triangles halved
/// keep their numbers, their other halves and the new points come behind the others. Returns which of the splits were
/// made, ascending. `order` is per point of the mesh before.
std::vector<std::uint32_t> split_edges(SurfaceMesh& mesh, std::span<const std::uint8_t> order,
                                       std::span<const EdgeSplit> splits, std::span<const Vec3d> at,
                                       const DefectRule& rule);

}  // namespace nacre
