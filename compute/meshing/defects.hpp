// Nacre: which particles spoil triangles, and where some are missing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// What to change about the particles of a mesh before they are triangulated again.
struct MeshDefects {
  struct NewPoint {
    Vec3d place;
    std::array<std::uint16_t, 2> materials;
  };
  std::int64_t bad_triangles = 0;      ///< with an angle under 25 degrees or a radius ratio under 0.4
  std::int64_t nonmanifold_edges = 0;  ///< where two materials meet in more than two facets
  std::vector<std::uint32_t> remove;   ///< points of the mesh, ascending; no two of them share a triangle
  std::vector<NewPoint> insert;        ///< near the interface of two materials
};

/// Bad triangles come from particles that are far too close together (under half of the smaller `size`): one of the two is
/// to go, the one on the surface rather than the one on a curve, on a curve rather than at a point; or, where all edges are
/// long, from one that lies flat between its neighbours: it is to go if it is on a surface. Edges where a surface touches
/// itself show that it is too coarsely sampled: new points in the middle of the facets there. `order` (2 surface, 1 curve,
/// 0 point) and `size` (world units) are per point of the mesh.
MeshDefects find_defects(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, std::span<const float> size);

}  // namespace nacre
