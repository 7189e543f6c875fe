// Nacre: closest points of a triangulated surface.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "error.hpp"
#include "export.hpp"

namespace nacre {

/// One entry per query.
struct ClosestPoints {
  std::vector<std::array<double, 3>> points;  ///< of the surface, nearest to the query
  std::vector<std::uint32_t> triangles;       ///< that contain them; the first of several
  std::vector<double> distance;               ///< from the query, not signed
};

/// The closest points of a surface, exact up to rounding, wherever the queries are. Throws Error where there are no
/// triangles, a corner is no point, or a coordinate is not finite; Interrupted soon after `*stop` (may be null) is set.
NACRE_API ClosestPoints closest_points(std::span<const std::array<double, 3>> points,
                                       std::span<const std::array<std::uint32_t, 3>> triangles,
                                       std::span<const std::array<double, 3>> queries,
                                       const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
