// Nacre: closest interface points of the voxels around, and the signed distance that follows from them.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/field/interface_points.hpp"
#include "compute/field/nearest_points.hpp"

namespace nacre {

/// For each cell of a lattice within `reach` voxels of an interface: which interface point is the closest to its
/// centre.
struct DistanceFieldView {
  TilesView tiles;
  const std::uint32_t* nearest = nullptr;  ///< per slot of the tiles: number of an interface point, or `none`
  const InterfacePoint* point = nullptr;
  float reach = 0;

  NACRE_HD const Lattice& lattice() const { return tiles.lattice; }
  NACRE_HD Vec3f position(std::uint32_t q) const {
    return {point[q].position.x, point[q].position.y, point[q].position.z};
  }
  /// What a cell knows.
  NACRE_HD std::uint32_t at(const Int3& cell) const {
    const std::int64_t slot = tiles.slot(cell);
    return slot < 0 ? none : nearest[slot];
  }

  /// The closest of the points that the eight cells around `p` know (outside of the lattice: the cells nearest to it);
  /// `none` where they know none.
  NACRE_HD std::uint32_t closest(const Vec3f& p, float& distance) const {
    const Lattice& l = lattice();
    const Int3 first{int(std::floor(p.x / l.spacing.x - 0.5f)), int(std::floor(p.y / l.spacing.y - 0.5f)),
                     int(std::floor(p.z / l.spacing.z - 0.5f))};
    std::uint32_t best = none;
    float least = 3e38f;
    for (int k = 0; k < 8; ++k) {
      const std::uint32_t q = at(max(Int3(0), min(first + Int3(k & 1, k >> 1 & 1, k >> 2), l.cells - Int3(1))));
      if (q == none || q == best) continue;
      const Vec3f r = position(q) - p;
      if (dot(r, r) < least) least = dot(r, r), best = q;
    }
    distance = std::sqrt(least);
    return best;
  }
};

/// Interface points and which of them is the closest to each cell of a lattice, in permanent memory.
struct DistanceField {
  LatticeTiles tiles;
  Array<std::uint32_t> nearest;  ///< per slot of the tiles
  Array<InterfacePoint> point;   ///< in the order of their cells' slots
  float reach = 0;
  const Lattice& lattice() const { return tiles.lattice; }
  DistanceFieldView view() const { return {tiles.view(), nearest.data(), point.data(), reach}; }
  std::int64_t bytes() const { return tiles.bytes() + std::int64_t(nearest.bytes() + point.bytes()); }
};

/// Points of all interfaces, at least one per boundary cell of `lattice_over`, and for each cell the nearest of them
/// within `reach` voxels. Points are exact, and so is which is the nearest.
template <class Backend>
DistanceField distance_field(Executor<Backend>& exec, const MaterialBricks& b, float spacing, float reach) {
  Arena& arena = exec.arena();
  DistanceField d;
  d.tiles = tiles_near(exec, b, lattice_over(b, spacing), reach);
  d.reach = reach;
  d.nearest = arena.permanent<std::uint32_t>(d.tiles.slots());
  d.point = find_interface_points(exec, b, d.tiles, d.nearest);
  find_nearest_points(exec, d.tiles, d.point, reach, d.nearest);
  return d;
}

}  // namespace nacre
