// Nacre: which bricks of cells are near the triangles of a cluster, found without visiting the empty ones.
#pragma once

#include <cstdint>

#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/clusters.hpp"
#include "compute/math/bisection.hpp"
#include "compute/math/morton.hpp"

namespace nacre {

/// Bricks that a process has, by their Morton codes: all; those of a range; or those in a list.
struct WantedBricks {
  std::uint64_t first = 0, last = ~std::uint64_t(0);  ///< the range, without `last`
  const std::uint64_t* code = nullptr;                ///< the list, ascending; null: the range
  std::uint64_t count = 0;

  NACRE_HD bool contains(std::uint64_t wanted) const {
    if (!code) return wanted >= first && wanted < last;
    const std::uint64_t at = first_not_below(code, std::uint64_t(0), count, wanted);
    return at < count && code[at] == wanted;
  }
};

}  // namespace nacre

namespace nacre::detail {

/// Calls visit(Morton code) for the bricks that come within `radius` cells of a cluster, and for a few more.
struct BricksNearCluster {
  const Corners* corners;
  const std::uint32_t* start;
  const ClusterBound* bound;
  Int3 bricks;
  double cells_per_brick, radius;
  WantedBricks wanted{};

  template <class Visit>
  NACRE_HD void operator()(std::int64_t k, Visit&& visit) const {
    const double scale = 1.0 / cells_per_brick, margin = radius * scale;
    auto emit = [&](const Int3& brick) {
      const std::uint64_t code = morton(brick);
      if (wanted.contains(code)) visit(code);
    };
    const double spread = bound[k].radius * scale;
    // For a triangle smaller than a brick, few bricks are near the ball around it and not near the triangle.
    if (spread > 1 && start[k + 1] - start[k] == 1) {
      for_cells_near(corners[start[k]] * scale, margin, bricks, emit);
      return;
    }
    const Vec3d centre = Vec3d(bound[k].centre) * scale;
    const double reach = spread * 1.0001 + margin + 1e-4 + 1.1e-7 * bricks.x;  // the centre is in single precision
    Int3 first, last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = clamp_cell(centre[axis] - reach, bricks[axis]);
      last[axis] = clamp_cell(centre[axis] + reach, bricks[axis]);
    }
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          const Vec3d low{double(x), double(y), double(z)};
          const Vec3d nearest = max(low, min(low + Vec3d(1.0), centre)) - centre;
          if (dot(nearest, nearest) <= reach * reach) emit({x, y, z});
        }
  }
};

}  // namespace nacre::detail
