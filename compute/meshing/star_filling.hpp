// Nacre: holes between agreed triangles are filled, and widened where that fails.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/star_finder.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// What fills the holes; corners are items.
struct StarFilling {
  std::vector<Triangle> triangles;
  std::int64_t holes = 0;
  std::vector<std::uint32_t> around;     ///< items of the loops around them
  std::vector<std::uint32_t> opened;     ///< items whose agreed triangles have gone so that holes became wider
  std::vector<std::uint32_t> unsettled;  ///< items at what stays open
};

/// Fills the holes between the triangles that the stars of `finder` agree on. One that cannot be filled, or not without
/// edges that are there already, is widened by the triangles at its items, and so again for some rounds; a triangle
/// that stands alone goes. The stars are changed by that until they are found again. `incomplete` as for find_holes.
StarFilling fill_holes(StarFinder& finder, std::vector<std::uint32_t> incomplete);

}  // namespace nacre
