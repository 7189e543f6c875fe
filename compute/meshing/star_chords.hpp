// Nacre: edges between two rims that more than one surface has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star_items.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Particles at edges between rims that are no rims themselves, and that two surfaces have: what lies between these has
/// no thickness there, and touches itself. Corners of `triangles` are items.
std::vector<std::uint32_t> at_shared_chords(const StarItems& items, std::span<const Triangle> triangles);

/// Where two surfaces have such an edge, exchanges it in one of them for the other diagonal of its two triangles, if
/// these face the same way then and there is no such edge yet: in the surface where the worse triangle is better.
void exchange_shared_chords(const StarItems& items, std::vector<Triangle>& triangles);

}  // namespace nacre
