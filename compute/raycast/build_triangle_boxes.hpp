// Nacre: the tree of boxes around triangles, on either backend.
#pragma once

#include "compute/device/executor.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/math/morton.hpp"
#include "compute/raycast/triangle_boxes.hpp"

namespace nacre {

/// The tree, and who owns its arrays.
struct TriangleBoxes {
  Array<TriangleBoxesView::Box> box;
  Array<std::uint32_t> order;
  std::uint32_t leaves = 0;

  TriangleBoxesView view() const { return {box.data(), order.data(), leaves, std::uint32_t(order.size())}; }
  std::uint64_t bytes() const { return box.bytes() + order.bytes(); }
};

namespace detail {

/// Places a triangle on the Morton curve by its centroid.
struct PlaceOnCurve {
  MeshView mesh;
  Vec3d low;
  double scale;  ///< to 0 .. 2^20 - 1
  std::uint64_t* code;
  std::uint32_t* order;
  NACRE_HD void operator()(std::int64_t i) const {
    const Corners t = mesh.corners(std::uint32_t(i));
    const Vec3d g = ((t.a + t.b + t.c) / 3.0 - low) * scale;
    constexpr int size = 1 << 20;
    code[i] = morton({clamp_cell(g.x, size), clamp_cell(g.y, size), clamp_cell(g.z, size)});
    order[i] = std::uint32_t(i);
  }
};

/// The box of a leaf, as much wider as single precision rounds.
struct BoundLeaf {
  MeshView mesh;
  TriangleBoxesView tree;
  TriangleBoxesView::Box* box;
  NACRE_HD void operator()(std::int64_t leaf) const {
    TriangleBoxesView::Box all;
    for (std::uint32_t k = 0; k < TriangleBoxesView::leaf_size; ++k) {
      const std::uint64_t i = std::uint64_t(leaf) * TriangleBoxesView::leaf_size + k;
      if (i >= tree.triangles) break;
      const Corners t = mesh.corners(tree.order[i]);
      for (int axis = 0; axis < 3; ++axis) {
        const double a = t.a[axis], b = t.b[axis], c = t.c[axis];
        const double low = a < b ? (a < c ? a : c) : b < c ? b : c, high = a > b ? (a > c ? a : c) : b > c ? b : c;
        const double slack = 1e-3 + 1.2e-7 * (high > -low ? high : -low);
        all.low[axis] = min(all.low[axis], float(low - slack));
        all.high[axis] = max(all.high[axis], float(high + slack));
      }
    }
    box[tree.leaves + leaf] = all;
  }
};

struct CombineBoxes {
  std::uint32_t first;  ///< of the level
  TriangleBoxesView::Box* box;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t node = first + std::uint32_t(i);
    const TriangleBoxesView::Box &a = box[2 * node], &b = box[2 * node + 1];
    box[node] = {min(a.low, b.low), max(a.high, b.high)};
  }
};

}  // namespace detail

/// Makes the boxes fit the triangles of `mesh` as they are now; their order stays.
template <class Backend>
void bound_triangles(Executor<Backend>& exec, const MeshView& mesh, const TriangleBoxes& tree) {
  exec.for_each(tree.leaves, detail::BoundLeaf{mesh, tree.view(), tree.box.data()});
  for (std::uint32_t first = tree.leaves / 2; first > 0; first /= 2)
    exec.for_each(first, detail::CombineBoxes{first, tree.box.data()});
}

/// Builds the tree over `triangles` triangles that lie within `dims` cells from the origin. Its arrays are permanent in
/// the executor's arena.
template <class Backend>
TriangleBoxes build_triangle_boxes(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles,
                                   const Vec3d& dims) {
  Arena& arena = exec.arena();
  TriangleBoxes tree;
  if (triangles == 0) return tree;
  tree.leaves = 1;
  while (std::uint64_t(tree.leaves) * TriangleBoxesView::leaf_size < triangles) tree.leaves *= 2;
  tree.order = arena.permanent<std::uint32_t>(triangles);
  tree.box = arena.permanent<TriangleBoxesView::Box>(2 * std::size_t(tree.leaves));
  {
    Arena::Scope scope(arena);
    Array<std::uint64_t> code = arena.temporary<std::uint64_t>(triangles);
    const double longest = dims.x > dims.y ? (dims.x > dims.z ? dims.x : dims.z) : dims.y > dims.z ? dims.y : dims.z;
    exec.for_each(triangles, detail::PlaceOnCurve{mesh, {}, ((1 << 20) - 1) / longest, code.data(), tree.order.data()});
    exec.sort_pairs(code.data(), tree.order.data(), triangles);
  }
  bound_triangles(exec, mesh, tree);
  return tree;
}

}  // namespace nacre
