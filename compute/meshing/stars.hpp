// Nacre: triangles read off from the particles themselves: each finds its neighbours, and a triangle stands where its
// three corners agree.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/item_tree.hpp"
#include "compute/meshing/star_items.hpp"

namespace nacre {

/// The neighbours of one item, counter-clockwise: those whose bisecting planes bound its Voronoi cell in the tangent
/// plane. On a rim from the next item of the rim to the previous one, else closed.
struct Star {
  static constexpr int most = 20;
  std::array<std::uint32_t, most> ring;
  std::uint8_t count = 0;
  bool closed = false;
  bool hidden = false;       ///< another item has the same position; it has no neighbours
  float reach = 0;           ///< nothing farther away was looked at, the items beside it on a rim excepted
  std::uint32_t gaps = 0;    ///< bit k: ring[k] and the one after it are no neighbours of each other
  std::uint32_t agreed = 0;  ///< bit k: triangle (item, ring[k], the one after it) is in the stars of all its corners

  int after(int k) const { return k + 1 == count ? 0 : k + 1; }
  /// Whether a triangle may begin with ring[k].
  bool has_triangle(int k) const { return !(gaps >> k & 1) && (closed || k + 1 < count) && count > 1; }
  bool has(std::uint32_t a, std::uint32_t b) const {
    for (int k = 0; k < count; ++k)
      if (ring[std::size_t(k)] == a) return has_triangle(k) && ring[std::size_t(after(k))] == b;
    return false;
  }
};

/// Puts the stars of the items that `wanted` marks into `stars`, one for each item; what is agreed is not known yet. A
/// star depends on the items within its reach alone, and not on their numbers. In parallel.
void cut_stars(const StarItems& items, const ItemTree& tree, std::span<const std::uint8_t> wanted,
               std::vector<Star>& stars);

}  // namespace nacre
