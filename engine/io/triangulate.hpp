// Nacre: triangulates a polygon in space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Appends the triangles of `polygon` (corners as indices into `points`, all valid and finite) to `out`, oriented as
/// the polygon is; at most corners - 2 of them. Quads are cut along the shorter diagonal that lies inside, convex
/// polygons become fans (round ones with more than 64 corners are halved again and again, which leaves few long
/// triangles), others are cut by ear clipping in the plane of their mean normal.
void triangulate(std::span<const std::uint32_t> polygon, const std::vector<Vec3d>& points, std::vector<Triangle>& out);

}  // namespace nacre
