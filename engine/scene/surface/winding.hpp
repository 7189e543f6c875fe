// Nacre: which points coincide, and triangles wound alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// For each point the smallest index of a point at exactly the same position (itself, where there is none before it).
std::vector<std::uint32_t> first_at_position(std::span<const Vec3d> points);

/// What `make_winding_consistent` did.
struct WindingReport {
  std::size_t duplicates = 0;        ///< triangles dropped because an earlier one has the same three points
  std::size_t flipped = 0;           ///< triangles turned over to agree with the majority of their part
  std::size_t turned_parts = 0;      ///< closed parts that faced inwards
  std::size_t turned_triangles = 0;  ///< of closed parts that faced inwards
  std::size_t closed_triangles = 0;  ///< of all closed parts
  std::size_t contradictions = 0;    ///< edges whose two triangles cannot agree: the surface is one-sided
};

/// Winds `triangles` consistently across all edges with exactly two triangles, drops duplicates, and turns closed parts
/// outwards. `open`: gets 1 for each triangle that is left if its part is not closed. `same[point]` as from
/// `first_at_position`; no triangle may use one position twice. Linear in triangles, but for sorting the triangles
/// around each point.
WindingReport make_winding_consistent(std::span<const Vec3d> points, std::span<const std::uint32_t> same,
                                      std::vector<Triangle>& triangles, std::vector<std::uint8_t>* open = nullptr);

}  // namespace nacre
