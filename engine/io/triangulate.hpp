// Nacre: a polygon in space cut into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/grid/vec.hpp"

namespace nacre {

/// Appends the triangles of `polygon` (corners as indices into `points`, all valid and finite) to `out`, turned as the
/// polygon is; at most corners - 2 of them. Quads are cut along the shorter diagonal that lies inside, convex polygons
/// are fanned, others have their ears clipped in the plane of their mean normal.
void triangulate(std::span<const std::uint32_t> polygon, const std::vector<Vec3d>& points, std::vector<Triangle>& out);

}  // namespace nacre
