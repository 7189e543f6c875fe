// Nacre: where a ray meets the surface of the two-level grid.
#pragma once

#include <cmath>

#include "compute/raycast/ray.hpp"

namespace nacre {

/// First hit of the ray with the surface. Empty bricks are crossed in one step; inside a brick the stored distance says
/// how far the ray may go without meeting anything; in a cell that the surface passes through its triangles are tested.
NACRE_HD inline bool cast(const ClosestPointGridView& grid, const MeshView& mesh, const Ray& ray, Hit& hit) {
  const Int3 dims = grid.dims();
  const Vec3f origin(ray.origin), direction(ray.direction);  // the grid is small: single precision finds the cells
  const Vec3f inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  const float speed = length(direction);
  float t = 0, end = 1e30f;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < 0 || origin[axis] >= float(dims[axis])) return false;
      continue;
    }
    float enter = -origin[axis] * inverse[axis], leave = (float(dims[axis]) - origin[axis]) * inverse[axis];
    if (enter > leave) {
      const float swap = enter;
      enter = leave;
      leave = swap;
    }
    t = enter > t ? enter : t;
    end = leave < end ? leave : end;
  }
  const float nudge = 1e-3f / speed;
  t += nudge;
  // Where the ray, now at `t`, leaves the box of the grid with this lower corner.
  auto leave_box = [&](const Vec3f& low, float size) {
    float out = 1e30f;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const float wall = low[axis] + (direction[axis] > 0 ? size : 0.0f);
      const float at = (wall - origin[axis]) * inverse[axis];
      // Rounded onto the wall already: it is behind after 1e-4 cells along this axis, which is far for a ray that runs
      // along the wall; such a ray would stand still otherwise.
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
      t = out + nudge;
      continue;
    }
    const float out = leave_box(Vec3f(cell), 1.0f);
    const std::uint32_t first = grid.touch_start[at], last = grid.touch_start[at + 1];
    if (first == last) {  // no surface here: the nearest is at least this far from anywhere in the cell
      const float skip = (grid.offset[at].w - 0.8661f) / speed;
      t = (out > t + skip ? out : t + skip) + nudge;
      continue;
    }
    for (std::uint32_t k = first; k < last; ++k) intersect(mesh, grid.touch_triangle[k], ray, hit);
    if (hit.triangle != none && hit.t <= out + nudge) return true;
    t = out + nudge;
  }
  return hit.triangle != none;
}

}  // namespace nacre
