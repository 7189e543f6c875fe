// Nacre: the Delaunay triangulation of the particles.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/grid/vec.hpp"

namespace nacre {

/// The finite cells, in an order that depends on the points alone (not on threads): ascending by their sorted vertices.
struct DelaunayCells {
  /// Indices of points; ascending but for the last two, which are swapped where that makes the volume positive.
  std::vector<std::array<std::uint32_t, 4>> vertices;
  std::vector<std::array<std::int32_t, 4>>
      neighbours;                    ///< per cell: the one opposite of vertex k; -1 outside of the hull
  std::vector<Vec3d> circumcentres;  ///< finite; see circumcentre_reach for cells next to flat
};

/// Delaunay triangulation on `threads` threads (0: all of the arena that it is called in; 1 under the thread
/// sanitizer). Of points that coincide the first is used. Throws Error where there are fewer than four points, all lie
/// in one plane or one is not finite, and Interrupted soon after `*stop` is set.
DelaunayCells delaunay(std::span<const Vec3d> points, int threads = 0, const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
