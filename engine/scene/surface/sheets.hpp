// Nacre: two sheets in one place, as files of flow simulations have them for thin walls.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Triangles of second sheets: they lie on others, face the other way, and have points of their own, on which other
/// values are known.
struct SecondSheets {
  std::vector<std::uint32_t> triangles;  ///< ascending
  std::vector<std::uint32_t> backing;    ///< for each a triangle of the first sheet that it lies on
  bool suspected = false;                ///< some triangles lie on others and face the other way, of whatever sheet
};

/// Finds them among `triangles`, however either sheet's polygons were divided into triangles. Of two sheets the one
/// with the earlier triangle is the first. `same[point]`: the first point at the same position. Linear in triangles,
/// but for those around one point.
SecondSheets find_second_sheets(std::span<const Vec3d> points, std::span<const std::uint32_t> same,
                                std::span<const Triangle> triangles);

}  // namespace nacre
