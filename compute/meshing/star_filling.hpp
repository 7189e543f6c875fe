// Nacre: holes between agreed triangles are filled, and widened where that fails.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/star_device.hpp"
#include "compute/meshing/star_openings.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// What fills the holes; corners are items.
struct StarFilling {
  std::vector<Triangle> triangles;
  std::int64_t holes = 0;
  std::vector<std::uint32_t> around;     ///< items of the loops around them
  std::vector<Triangle> removed;         ///< agreed ones, so that holes became wider; the smallest item first
  std::vector<std::uint32_t> unsettled;  ///< items at what stays open
};

/// Fills the holes between the triangles that stars agree on. One that cannot be filled, or not without
/// edges that are there already, is widened by the triangles at its items, and so again for some rounds; a triangle
/// that stands alone goes. What is removed is open in `openings`, which are of these stars.
StarFilling fill_holes(const FoundStars& found, StarOpenings& openings);

}  // namespace nacre
