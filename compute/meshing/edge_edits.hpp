// Nacre: bad triangles removed by changing edges, where the particles stay as they are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/defects.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// What `edit_edges` did.
struct EdgeEdits {
  std::int64_t flips = 0, contractions = 0;
  std::vector<std::uint32_t> kept;     ///< which of the points are left, ascending
  std::vector<std::uint32_t> crossed;  ///< of those left, by their new numbers: a curve was led through them
};

/// Flips edges and contracts them at triangles that are bad by `rule`, the worst first, each time what leaves the best
/// triangles, as long as the worst of those that change becomes better. Topology stays as it is: an edge is flipped
/// between two triangles of one interface, if the mesh does not have the new one; a point within a surface is
/// contracted onto a neighbour if the two have no neighbours in common but those opposite their edge (the link
/// condition). No triangle turns by more than about 35 degrees. At triangles that are also bad by `worst_defects`
/// triangles may turn by up to 70 degrees, and points of curves are contracted, too: along their curve where that is
/// nearly straight, or across a strip of surface narrower than half the mean edge, if only the two materials beside
/// that have both ends; and where the mesh has the new edge of a flip, the flat tetrahedron between the two triangles
/// and others goes to the material on their other side (see give_away; counted as a flip), if no material is lost and
/// no surface touches itself for it. `order` (2 surface, 1 curve, 0 point) is per point of the mesh; points that are
/// contracted, or at the tip of such a tetrahedron, leave it.
EdgeEdits edit_edges(SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule);

}  // namespace nacre
