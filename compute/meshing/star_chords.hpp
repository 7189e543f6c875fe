// Nacre: edges between two rims that more than one surface has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star_device.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Particles at edges between rims that are no rims themselves, and that two surfaces have: what lies between these has
/// no thickness there, and touches itself.
std::vector<std::uint32_t> at_shared_chords(const StarItems& items, std::span<const RimTriangle> between_rims);

/// Where two surfaces have such an edge, exchanges it in one of them for the other diagonal of its two triangles, if
/// these face the same way then and there is no such edge yet, agreed or of `filled` triangles (corners are items): in
/// the surface where the worse triangle is better. Returns which of `between_rims` are changed; no others are between
/// rims afterwards.
std::vector<std::uint32_t> exchange_shared_chords(const StarItems& items, std::span<const Star> stars,
                                                  std::span<const Triangle> filled,
                                                  std::vector<RimTriangle>& between_rims);

}  // namespace nacre
