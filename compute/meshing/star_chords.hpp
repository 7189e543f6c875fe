// Nacre: edges between two rims that more than one surface has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star_items.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// The triangles, corners of which are items, that have two corners or more on rims; ascending. In parallel.
std::vector<std::uint32_t> triangles_between_rims(const StarItems& items, std::span<const Triangle> triangles);

/// Particles at edges between rims that are no rims themselves, and that two surfaces have: what lies between these has
/// no thickness there, and touches itself. `between` are the triangles between rims, or more.
std::vector<std::uint32_t> at_shared_chords(const StarItems& items, std::span<const Triangle> triangles,
                                            std::span<const std::uint32_t> between);

/// Where two surfaces have such an edge, exchanges it in one of them for the other diagonal of its two triangles, if
/// these face the same way then and there is no such edge yet: in the surface where the worse triangle is better. No
/// other triangle is between rims afterwards.
void exchange_shared_chords(const StarItems& items, std::span<const std::uint32_t> between,
                            std::vector<Triangle>& triangles);

}  // namespace nacre
