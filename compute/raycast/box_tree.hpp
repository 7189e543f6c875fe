// Nacre: a tree of boxes over triangles that move: rays and closest points on either backend.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/raycast/ray.hpp"

namespace nacre {

struct TriangleBox {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
};

/// Boxes over runs of triangles, combined in pairs to an implicit binary tree: node k lies over 2 k and 2 k + 1, from
/// 1; the leaves come last. When the triangles move, their order stays and the boxes are made anew.
struct BoxTreeView {
  static constexpr std::uint32_t run = 1;  ///< triangles in a leaf

  std::uint32_t leaves = 0;              ///< a power of two
  std::uint32_t triangles = 0;           ///< entries of `order`
  const std::uint32_t* order = nullptr;  ///< triangles along a curve through space
  const TriangleBox* box = nullptr;
};

/// Triangles along the Morton curve of their centres, for `BoxTreeView::order`.
std::vector<std::uint32_t> order_along_curve(std::span<const Vec3d> points, std::span<const Triangle> triangles);

/// The boxes of all nodes, 2 * `box_leaves` of them. They are rounded outwards.
std::vector<TriangleBox> boxes_over(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                    std::span<const std::uint32_t> order);
std::uint32_t box_leaves(std::size_t triangles);

namespace detail {

/// Where a ray enters a box; very large where it misses it, or meets it behind `farthest`.
struct BoxEntry {
  Vec3d origin, inverse;

  NACRE_HD explicit BoxEntry(const Ray& ray) : origin(ray.origin) {
    for (int axis = 0; axis < 3; ++axis) inverse[axis] = ray.direction[axis] != 0 ? 1 / ray.direction[axis] : 1e300;
  }

  NACRE_HD double operator()(const TriangleBox& box, double farthest) const {
    double enter = 0, leave = farthest;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - origin[axis]) * inverse[axis];
      const double b = (box.high[axis] - origin[axis]) * inverse[axis];
      const double first = a < b ? a : b, last = a < b ? b : a;
      enter = first > enter ? first : enter;
      leave = last < leave ? last : leave;
    }
    return enter <= leave ? enter : 1e301;
  }
};

NACRE_HD inline double squared_distance(const TriangleBox& box, const Vec3d& p) {
  const Vec3d away = max(Vec3d(box.low), min(Vec3d(box.high), p)) - p;
  return dot(away, away);
}

}  // namespace detail

/// First hit of the ray with the triangles of `mesh`.
NACRE_HD inline bool cast(const BoxTreeView& tree, const MeshView& mesh, const Ray& ray, Hit& hit) {
  struct Place {
    double enter;
    std::uint32_t node;
  } stack[32];
  const detail::BoxEntry entry(ray);
  int depth = 0;
  const double root = tree.leaves > 0 ? entry(tree.box[1], 1e300) : 1e301;
  if (root < 1e300) stack[depth++] = {root, 1};
  while (depth > 0) {
    const Place at = stack[--depth];
    if (at.enter > hit.t) continue;
    if (at.node >= tree.leaves) {
      const std::uint32_t first = (at.node - tree.leaves) * BoxTreeView::run;
      for (std::uint32_t k = first; k < first + BoxTreeView::run && k < tree.triangles; ++k)
        intersect(mesh, tree.order[k], ray, hit);
      continue;
    }
    Place a{entry(tree.box[2 * at.node], hit.t), 2 * at.node}, b{entry(tree.box[2 * at.node + 1], hit.t), a.node + 1};
    if (a.enter < b.enter) {
      const Place farther = b;
      b = a;
      a = farther;
    }
    if (a.enter < 1e300) stack[depth++] = a;  // the nearer one comes next
    if (b.enter < 1e300) stack[depth++] = b;
  }
  return hit.triangle != none;
}

/// The nearest triangle; `squared` is at first how far to look.
struct NearestTriangle {
  double squared;
  Vec3d point{};
  std::uint32_t triangle = none;
};

NACRE_HD inline void find_nearest(const BoxTreeView& tree, const MeshView& mesh, const Vec3d& p,
                                  NearestTriangle& nearest) {
  struct Place {
    double squared;
    std::uint32_t node;
  } stack[32];
  int depth = 0;
  if (tree.leaves > 0) stack[depth++] = {detail::squared_distance(tree.box[1], p), 1};
  while (depth > 0) {
    const Place at = stack[--depth];
    if (at.squared > nearest.squared) continue;
    if (at.node >= tree.leaves) {
      const std::uint32_t first = (at.node - tree.leaves) * BoxTreeView::run;
      for (std::uint32_t k = first; k < first + BoxTreeView::run && k < tree.triangles; ++k) {
        const Vec3d point = closest_point(mesh.corners(tree.order[k]), p), away = point - p;
        const double d = dot(away, away);
        if (d < nearest.squared || (d == nearest.squared && tree.order[k] < nearest.triangle))
          nearest = {d, point, tree.order[k]};
      }
      continue;
    }
    Place a{detail::squared_distance(tree.box[2 * at.node], p), 2 * at.node};
    Place b{detail::squared_distance(tree.box[2 * at.node + 1], p), 2 * at.node + 1};
    if (a.squared < b.squared) {
      const Place farther = b;
      b = a;
      a = farther;
    }
    if (a.squared <= nearest.squared) stack[depth++] = a;
    if (b.squared <= nearest.squared) stack[depth++] = b;
  }
}

}  // namespace nacre
