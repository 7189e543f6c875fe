// Nacre: materials of Delaunay cells in the void around a patch.
#pragma once

#include <cstdint>
#include <span>

#include "compute/meshing/delaunay.hpp"

namespace nacre {

/// Cells with a corner beyond the end of `wanted` (a guard) lie in the void around the points of a patch. Near a wanted
/// point all particles are in the patch, so that no interface is in the void there: void cells that meet in facets with
/// a guard and a wanted corner get the material that most of them have, the lowest of several. `label` holds one per
/// cell.
void label_void(const DelaunayCells& cells, std::span<const std::uint8_t> wanted, std::span<std::uint16_t> label);

}  // namespace nacre
