// Nacre: the triangles around particles, as the sides opposite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// A triangle's side, seen from the corner opposite: its ends as numbers of particles.
struct RingEdge {
  std::uint32_t a, b;
};

/// The sides opposite of particle i are edge[first[i]] to edge[first[i + 1] - 1], in the order of the triangles.
struct TriangleRings {
  std::vector<std::uint32_t> first;
  std::vector<RingEdge> edge;
};

/// Rings of those points of `mesh` that `wanted` marks, for `particles` particles, of which point_of[v] is point v.
/// Throws Error where there are more than 1.4 billion triangles.
TriangleRings triangle_rings(const SurfaceMesh& mesh, std::span<const std::uint32_t> point_of,
                             std::span<const std::uint8_t> wanted, std::size_t particles);

}  // namespace nacre
