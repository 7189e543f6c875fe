// Nacre: where a ray meets the surface of the two-level grid.
#pragma once

#include <cmath>

#include "compute/raycast/ray.hpp"

namespace nacre {

/// First hit of the ray with the surface. Empty bricks are crossed in one step; inside a brick the stored distance
/// says how far the ray may advance without hitting anything; in a cell that the surface passes through, its triangles
/// are tested.
NACRE_HD inline bool cast(const ClosestPointGridView& grid, const MeshView& mesh, const Ray& ray, Hit& hit) {
  const Int3 dims = grid.dims();
  double entry = 0, exit = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = ray.origin[axis], along = ray.direction[axis];
    if (along == 0) {
      if (at < 0 || at >= dims[axis]) return false;
      continue;
    }
    const double low = -at / along, high = (dims[axis] - at) / along;
    entry = max(entry, min(low, high));
    exit = min(exit, max(low, high));
  }
  if (!(entry < exit)) return false;
  // Single precision finds the cells from the entry point on, however far away the ray began, since the grid is small.
  const Vec3f origin(ray.at(entry)), direction(ray.direction);
  const Vec3f inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  const float speed = length(direction), nudge = 1e-3f / speed;
  const auto past = [&](float wall) { return wall + (nudge > 2.5e-7f * wall ? nudge : 2.5e-7f * wall); };
  const auto end = float(exit - entry);
  float t = past(0);
  // Parameter at which the ray, now at `t`, leaves the box of the grid with this lower corner.
  auto leave_box = [&](const Vec3f& low, float size) {
    float out = 1e30f;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const float wall = low[axis] + (direction[axis] > 0 ? size : 0.0f);
      const float at = (wall - origin[axis]) * inverse[axis];
      // If rounding put the position onto the wall already, the wall is passed 1e-4 cells later along this axis. That
      // is far for a ray that runs along the wall, which would otherwise not advance at all.
      const float later = at > t ? at : t + 1e-4f * std::fabs(inverse[axis]);
      out = later < out ? later : out;
    }
    return out;
  };
  while (t < end) {
    const Int3 cell = floor_cell(origin + direction * t);
    if (!grid.inside(cell)) return false;
    const std::uint32_t at = grid.address(cell);
    if (at == none) {
      const Int3 brick{grid.divide(cell.x), grid.divide(cell.y), grid.divide(cell.z)};
      const float out = leave_box(Vec3f(brick * Int3(grid.sub)), float(grid.sub));
      t = past(out);
      continue;
    }
    const float out = leave_box(Vec3f(cell), 1.0f);
    const std::uint32_t first = grid.touch_start[at], last = grid.touch_start[at + 1];
    if (first == last) {  // no surface here: the nearest one is at least this far from any point of the cell
      const float skip = (min(grid.offset[at].w, grid.radius) - 0.8661f) / speed;
      t = past(out > t + skip ? out : t + skip);
      continue;
    }
    for (std::uint32_t k = first; k < last; ++k) intersect(mesh, grid.touch_triangle[k], ray, hit);
    if (hit.triangle != none && hit.t - entry <= past(out)) return true;
    t = past(out);
  }
  return hit.triangle != none;
}

}  // namespace nacre
