// Nacre: what stars leave open between the triangles that they agree on, and how it is filled.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star.hpp"
#include "compute/meshing/star_items.hpp"

namespace nacre {

/// A hole of one surface: items around it, so that what is to be filled lies to the left seen against the normals, and
/// items within it that no triangle has yet. Begins with its smallest item.
struct StarHole {
  std::vector<std::uint32_t> loop, within;
  friend bool operator==(const StarHole&, const StarHole&) = default;
};

struct StarHoles {
  std::vector<StarHole> holes;
  std::vector<std::uint32_t> alone;  ///< items in no hole without a triangle, ascending: maybe bodies of their own
  std::vector<std::uint32_t> open;   ///< items of chains of edges that do not close: a rim is broken there
};

/// All holes, ascending by their smallest items. `incomplete` are the items, ascending, that may be at or within one.
StarHoles find_holes(const StarItems& items, std::span<const Star> stars, std::span<const std::uint32_t> incomplete);

/// The triangles that fill a hole, corners as items, counter-clockwise. Empty where it cannot be filled without a
/// triangle or an edge that there is already.
std::vector<Triangle> fill_hole(const StarItems& items, std::span<const Star> stars, const StarHole& hole);

}  // namespace nacre
