// Nacre: how deep a process knows what lies around its bricks.
#include "compute/flow/halo_depths.hpp"

#include <algorithm>
#include <cmath>

#include "compute/embedding/brick_octree.hpp"
#include "compute/flow/streaks.hpp"

namespace nacre {

/// A pixel of a picture stands for some tens of cells where the surface is seen from the side.
constexpr int pictures = 5;

HaloDepths HaloDepths::of(double radius, double step_cells, int streaks) {
  const auto bricks = [](int cells) { return (cells + BrickOctreeView::width - 1) / BrickOctreeView::width; };
  const int foot = int(radius * 1.001 + 0.5);  // cells from a cell to the one that holds its closest point
  HaloDepths depths;
  depths.deposits = bricks(int(std::ceil(2.04 * step_cells)) + 2 + std::max(1, foot));
  depths.beside = bricks(2 + foot);
  depths.detail = bricks(2 + foot);
  depths.whole = std::max({depths.deposits, depths.detail + 1, pictures});
  if (streaks > 0) {
    const int far = segment_length * (streak_segments(streaks) + 1) + 2 * streak_slack;
    depths.whole = std::max(depths.whole, bricks(far + 2 * foot));
  }
  return depths;
}

}  // namespace nacre
