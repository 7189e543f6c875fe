// Nacre: what the Delaunay triangulations of CGAL and of Qhull share: the points they take, and the order of cells.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "compute/meshing/delaunay.hpp"

namespace nacre {

/// Throws Error where there are fewer than four points, too many, or one is not finite.
void check_delaunay_points(std::span<const Vec3d> points);

/// Throws the Error for points that all lie in one plane.
[[noreturn]] void refuse_flat_points();

/// Corners of a positively oriented cell ascending, then the last two swapped where the permutation is odd; neighbours
/// along with them.
void order_corners(std::array<std::uint32_t, 4>& cell, std::array<std::int32_t, 4>& neighbours);

/// Cells with ordered corners, as DelaunayCells has them: ascending, and with their circumcentres. In parallel.
DelaunayCells in_canonical_order(const DelaunayCells& raw, std::span<const Vec3d> points,
                                 const std::atomic<bool>* stop);

}  // namespace nacre
