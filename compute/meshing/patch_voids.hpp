// Nacre: the materials of a patch's cells where it has no particles.
#pragma once

#include <cstdint>
#include <span>

#include "compute/meshing/delaunay.hpp"

namespace nacre {

/// Gives one label to cells of a patch that meet in a facet too long for its particles, so that no interface runs
/// through the void between them: the commonest label of cells that are `known`, or of all where none is. `reach`, per
/// particle: a facet is too long where one of its corners is farther than this from the particle; 0 asks nothing of it.
/// Points beyond the end of `reach` are guards. Depends on its arguments alone.
void unify_voids(std::span<const Vec3d> points, const DelaunayCells& cells, std::span<const double> reach,
                 std::span<const std::uint8_t> known, std::span<std::uint16_t> label);

}  // namespace nacre
