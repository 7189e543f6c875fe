// Nacre: a tree of boxes around triangles: for rays, where cells list many triangles or the triangles have moved, and
// for closest points.
#pragma once

#include <cstdint>

#include "compute/raycast/ray.hpp"

namespace nacre {

/// Boxes over runs of triangles along a Morton curve, combined in pairs to an implicit binary tree: node k stands over
/// nodes 2 k and 2 k + 1, the root is node 1, the leaves are the last half. Lengths are in cells.
struct TriangleBoxesView {
  static constexpr std::uint32_t leaf_size = 4;  ///< triangles

  struct Box {
    Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  };

  const Box* box = nullptr;
  const std::uint32_t* order = nullptr;  ///< triangles along the curve
  std::uint32_t leaves = 0;              ///< a power of two; 0: there is no tree
  std::uint32_t triangles = 0;

  NACRE_HD_INLINE explicit operator bool() const { return leaves > 0; }
};

namespace detail {

/// A ray as boxes are tested with it. Along an axis on which it does not move, planes are far ahead or far behind.
struct SlabRay {
  Vec3d origin, inverse;

  NACRE_HD_INLINE explicit SlabRay(const Ray& ray) : origin(ray.origin) {
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis];
      inverse[axis] = d > 1e-280 || d < -1e-280 ? 1 / d : d < 0 ? -1e280 : 1e280;
    }
  }

  /// Where the ray enters the box, at 0 at the earliest; very large if it misses it or meets it beyond `end`.
  NACRE_HD_INLINE double enter(const TriangleBoxesView::Box& box, double end) const {
    if (box.low.x > box.high.x) return 1e300;  // beyond the last triangle
    double from = 0, to = end;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (double(box.low[axis]) - origin[axis]) * inverse[axis];
      const double b = (double(box.high[axis]) - origin[axis]) * inverse[axis];
      const double near = a < b ? a : b, far = a < b ? b : a;
      from = near > from ? near : from;
      to = far < to ? far : to;
    }
    return from <= to ? from : 1e300;
  }
};

}  // namespace detail

/// First hit of the ray with any of the tree's triangles. `keep(triangle, ray, hit)` tests one of them.
template <class Keep>
NACRE_HD bool cast(const TriangleBoxesView& tree, const Ray& ray, Hit& hit, const Keep& keep) {
  const detail::SlabRay slabs(ray);
  std::uint32_t open[32];  // the farther of two children, one for each level
  int count = 0;
  std::uint32_t node = 1;
  if (slabs.enter(tree.box[1], hit.t) >= 1e300) return hit.triangle != none;
  for (;;) {
    if (node < tree.leaves) {
      const double left = slabs.enter(tree.box[2 * node], hit.t), right = slabs.enter(tree.box[2 * node + 1], hit.t);
      const std::uint32_t nearer = 2 * node + (right < left ? 1 : 0);
      if ((left < right ? left : right) < 1e300) {
        if ((left < right ? right : left) < 1e300) open[count++] = nearer ^ 1;
        node = nearer;
        continue;
      }
    } else {
      const std::uint32_t first = (node - tree.leaves) * TriangleBoxesView::leaf_size;
      const std::uint32_t rest = first < tree.triangles ? tree.triangles - first : 0;
      const std::uint32_t n = rest < TriangleBoxesView::leaf_size ? rest : TriangleBoxesView::leaf_size;
      for (std::uint32_t k = 0; k < n; ++k) keep(tree.order[first + k], ray, hit);
    }
    // What was met beyond a hit that has been found since is left out.
    do {
      if (count == 0) return hit.triangle != none;
      node = open[--count];
    } while (slabs.enter(tree.box[node], hit.t) >= 1e300);
  }
}

/// The nearest triangle; `squared` is at first how far to search.
struct NearestTriangle {
  double squared;
  Vec3d point{};
  std::uint32_t triangle = none;
};

/// Of equally distant triangles the lower number wins.
NACRE_HD inline void find_nearest(const TriangleBoxesView& tree, const MeshView& mesh, const Vec3d& p,
                                  NearestTriangle& nearest) {
  const auto away = [&](std::uint32_t node) {
    const TriangleBoxesView::Box& box = tree.box[node];
    if (box.low.x > box.high.x) return 1e300;  // beyond the last triangle
    const Vec3d d = max(Vec3d(box.low), min(Vec3d(box.high), p)) - p;
    return dot(d, d);
  };
  struct Open {
    double squared;
    std::uint32_t node;
  } open[33];
  int count = 0;
  if (tree) open[count++] = {away(1), 1};
  while (count > 0) {
    const Open at = open[--count];
    if (at.squared > nearest.squared) continue;
    if (at.node < tree.leaves) {
      const Open a{away(2 * at.node), 2 * at.node}, b{away(2 * at.node + 1), 2 * at.node + 1};
      const bool left = a.squared < b.squared;
      open[count++] = left ? b : a;
      open[count++] = left ? a : b;  // the nearer one comes next
      continue;
    }
    const std::uint32_t first = (at.node - tree.leaves) * TriangleBoxesView::leaf_size;
    for (std::uint32_t k = first; k < first + TriangleBoxesView::leaf_size && k < tree.triangles; ++k) {
      const Vec3d point = closest_point(mesh.corners(tree.order[k]), p), d = point - p;
      const double squared = dot(d, d);
      if (squared < nearest.squared || (squared == nearest.squared && tree.order[k] < nearest.triangle))
        nearest = {squared, point, tree.order[k]};
    }
  }
}

}  // namespace nacre
