// Nacre: where triangles of stars and facets of cells do not meet as they should.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star_mesh.hpp"

namespace nacre {

/// An edge that is not as it should be.
struct EdgeFault {
  std::array<std::uint32_t, 2> ends;
  bool open;  ///< a material passes it more often one way than the other; else the surface touches itself there
};

/// Faults at edges whose ends are both marked, ascending; one for each material.
std::vector<EdgeFault> edge_faults(const StarMesh& mesh, std::span<const std::uint8_t> marked);

/// Marked particles off the junctions that the surface of a material passes more than once.
std::vector<std::uint32_t> at_pinched_vertices(const StarMesh& mesh, std::span<const std::uint8_t> marked);
/// The same of all that may be, `mesh.joined`.
std::vector<std::uint32_t> at_pinched_joints(const StarMesh& mesh, std::size_t particles);

}  // namespace nacre
