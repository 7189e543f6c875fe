// Nacre: where a ray meets the surface in an octree: the tree skips empty space, and its leaves list triangles.
#pragma once

#include "compute/embedding/cells_near.hpp"
#include "compute/raycast/octree_walk.hpp"

namespace nacre {

namespace detail {
/// Longer lists of triangles are only tested if the ray meets a cell that the surface passes through.
inline constexpr std::uint64_t long_list = 24;

/// Whether the ray, in the brick at `low` (in its own coordinates) from `enter` on, meets a cell of the mask.
NACRE_HD inline bool meets_cells(const CellMask& mask, const AscendingRay& ray, const Int3& low, double enter) {
  Int3 cell = low;
  for (int half = 4; half > 0; half /= 2) ray.enter(cell, half, enter);
  for (;;) {
    const Int3 c = ray.unmirrored(cell, 1);
    if (mask.word[c.z & 7] >> (8 * (c.y & 7) + (c.x & 7)) & 1) return true;
    int axis;
    ray.leave(cell, 1, axis);
    if (++cell[axis] == low[axis] + BrickOctreeView::width) return false;
  }
}
}  // namespace detail

/// First hit of the ray with the surface. It is exact, against the triangles that touch the bricks on its way.
NACRE_HD inline bool cast(const BrickOctreeView& tree, const MeshView& mesh, const Ray& ray, Hit& hit) {
  if (tree.brick_count == 0) return false;
  const AscendingRay ascending(ray, tree.size());
  walk_octree(tree, tree.levels, ascending, [&](std::uint32_t brick, const Int3& low, double enter, double leave) {
    if (hit.t <= enter) return true;
    const std::uint64_t first = tree.list_start[brick], last = tree.list_start[brick + 1];
    if (last - first > detail::long_list && !detail::meets_cells(tree.brick[brick].surface, ascending, low, enter))
      return false;
    for (std::uint64_t k = first; k < last; ++k) intersect(mesh, tree.list[k], ray, hit);
    return hit.t <= leave;  // a hit beyond this brick may lie behind one that only the next brick lists
  });
  return hit.triangle != none;
}

namespace detail {
/// Parameter at which the ray meets the plane of a cell's closest triangle; very large if it is parallel to the plane.
NACRE_HD inline Hit meet_plane(const ThesisOctreeView& tree, CellIndex cell, const MeshView& mesh, const Ray& ray) {
  const std::uint32_t triangle = tree.point[cell].triangle;
  const Corners c = mesh.corners(triangle);
  const Vec3d n = plane_normal(c);
  const double along = dot(n, ray.direction);
  if (along == 0 || (ray.fronts_only && along > 0)) return {};
  const double t = dot(n, c.a - ray.origin) / along;
  return {t, triangle, Vec3f(barycentric(c, ray.at(t)))};
}

/// The nearest hit between two parameters, among the planes of the cells around `position` whose triangles are at most
/// half a cell away.
NACRE_HD inline Hit meet_planes_beside(const ThesisOctreeView& tree, const Int3& position, const MeshView& mesh,
                                       const Ray& ray, double from, double to) {
  ThesisOctreeView::Cursor cursor(tree);
  Hit nearest;
  for (int k = 0; k < 27; ++k) {
    const CellIndex cell = cursor.find(position + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    if (k == 13 || cell == no_cell || !tree.touches(cell)) continue;
    const Hit hit = meet_plane(tree, cell, mesh, ray);
    if (!(hit.t >= from && hit.t <= to && hit.t < nearest.t)) continue;
    const Vec3d at = ray.at(hit.t), away = closest_point(mesh.corners(hit.triangle), at) - at;
    if (dot(away, away) < 0.25) nearest = hit;
  }
  return nearest;
}
}  // namespace detail

/// First cell on the ray's way that the surface passes through and in which the ray meets the plane of the cell's
/// closest triangle. If the ray meets none for the length of a cell, the planes of neighbours count, too: near an edge,
/// the cell may know the face that the ray does not meet. The planes stand for all of the surface in the cell, because
/// the octree of the thesis knows no more. They shift the surface by up to a cell where it bends, ends or returns
/// within one cell, and are exact away from the edges of triangles larger than cells. Cells overlap by an eighth along
/// the ray, so that planes of neighbours which do not quite meet leave no crack.
NACRE_HD inline bool cast(const ThesisOctreeView& tree, const MeshView& mesh, const Ray& ray, Hit& hit) {
  if (tree.cells == 0) return false;
  const double cell_length = 1 / length(ray.direction), slack = 0.125 * cell_length;
  const AscendingRay ascending(ray, tree.size());
  Hit nearest;
  const auto leaf = [&](std::uint32_t cell, const Int3& low, double enter, double leave) {
    if (enter > nearest.t + cell_length) return true;
    if (!tree.touches(cell)) return false;
    const double from = enter > slack ? enter - slack : 0, to = leave + slack;
    const Hit here = detail::meet_plane(tree, cell, mesh, ray);
    if (here.t >= from && here.t <= to) {
      if (!(here.t > nearest.t + cell_length)) nearest = here;
      return true;
    }
    if (nearest.triangle == none)
      nearest = detail::meet_planes_beside(tree, ascending.unmirrored(low, 1), mesh, ray, from, to);
    return false;
  };
  walk_octree(tree, tree.depth(), ascending, leaf);
  hit = nearest;
  return hit.triangle != none;
}

}  // namespace nacre
