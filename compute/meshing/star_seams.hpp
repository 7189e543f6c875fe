// Nacre: where triangles of stars and facets of cells do not meet as they should.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star_mesh.hpp"

namespace nacre {

/// Ends of edges, both marked, that a material passes more often one way than the other, or that have more than two
/// triangles between the same two materials.
std::vector<std::uint32_t> at_open_edges(const StarMesh& mesh, std::span<const std::uint8_t> marked);

/// Marked particles off the junctions that the surface of a material passes more than once.
std::vector<std::uint32_t> at_pinched_vertices(const StarMesh& mesh, std::span<const std::uint8_t> marked);

}  // namespace nacre
