// Nacre: the values of a texture carried to another embedding of the same surface, or to a surface close to it.
#pragma once

#include <cmath>

#include "compute/embedding/thesis_octree.hpp"
#include "compute/flow/surface_cells.hpp"
#include "compute/raycast/triangle_boxes.hpp"

namespace nacre {

/// The cells of the thesis octree as kernels of `surface_cells.hpp` see them: each has a value.
struct ThesisSurface {
  ThesisOctreeView view;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex s, const Int3&) const {
    return {view.point[s].offset(view.quantum), view.point[s].triangle};
  }

  /// The band is too thin to say more than its surface cells do.
  NACRE_HD_INLINE bool foot_near(const Vec3d&, Vec3d&) const { return false; }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const ThesisSurface& surface) : cursor_(surface.view) {}
    NACRE_HD_INLINE NearSurfaceCell find(const Int3& cell) { return {cursor_.find(cell), true}; }

   private:
    ThesisOctreeView::Cursor cursor_;
  };
};

template <class Kernel>
struct OnThesisSurface {
  Kernel kernel;
  NACRE_HD void operator()(CellIndex s, CellIndex, const Int3& position, ThesisOctreeView::Cursor&) const {
    kernel(s, position);
  }
};

template <class Backend, class Kernel>
void for_each_surface_cell_of(Executor<Backend>& exec, const ThesisSurface& surface, std::int64_t,
                              const Kernel& kernel) {
  for_each_surface_cell(exec, surface.view, OnThesisSurface<Kernel>{kernel});
}

/// Where a point of a triangle was when the other shape of the same mesh was embedded: the material point stays. All in
/// cells of the domain of either.
struct SameMaterial {
  MeshView now, before;

  template <class Surface>
  NACRE_HD bool is_near(const Surface&, double, const Vec3d&, Vec3d&) const {
    return false;
  }

  NACRE_HD bool operator()(std::uint32_t triangle, const Vec3d& p, Vec3d& there) const {
    const Vec3d w = barycentric(now.corners(triangle), p);
    const Corners c = before.corners(triangle);
    there = c.a * w.x + c.b * w.y + c.c * w.z;
    return true;
  }
};

/// The closest point of another surface, as that one was when it was embedded. False where it is farther than `reach`.
struct ClosestMaterial {
  TriangleBoxesView tree;  ///< of the other surface as it is now
  MeshView now, before;    ///< that surface: as it is, and as it was embedded
  double scale;            ///< from cells of this domain to those of the other
  Vec3d shift;
  double reach;  ///< in cells of the other domain
  bool at_rest;  ///< the other surface is as it was embedded: its embedding knows closest points near it

  /// Where to look for a cell of the embedding before the triangles are searched. `texel`: edge of its cells.
  template <class Surface>
  NACRE_HD bool is_near(const Surface& embedded, double texel, const Vec3d& p, Vec3d& there) const {
    if (!at_rest) return false;
    const Vec3d position = p * scale + shift;
    if (!embedded.foot_near(position / texel, there)) {
      there = position;
      return true;
    }
    there = there * texel;
    const Vec3d d = there - position;
    return dot(d, d) <= reach * reach;
  }

  NACRE_HD bool operator()(std::uint32_t, const Vec3d& p, Vec3d& there) const {
    NearestTriangle nearest{reach * reach};
    find_nearest(tree, now, p * scale + shift, nearest);
    if (nearest.triangle == none) return false;
    return SameMaterial{now, before}(nearest.triangle, nearest.point, there);
  }
};

/// For each surface cell the one of the embedding before whose value it takes: that which holds the material point of
/// this cell's closest point, so that no value is blurred; `no_cell` where there is none.
template <class Surface, class Origin>
struct FindSource {
  Surface surface, before;
  Origin origin;
  double texel, texel_before;  ///< edge of a texture cell in cells of either domain
  CellIndex* source;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    const SurfaceFoot foot = surface.foot(s, position);
    const Vec3d point = (Vec3d(position) + Vec3d(0.5) + Vec3d(foot.offset)) * texel;
    Vec3d there;
    source[s] = origin.is_near(before, texel_before, point, there) ? cell_at(there) : no_cell;
    if (source[s] == no_cell && origin(foot.triangle, point, there)) source[s] = cell_at(there);
  }

  NACRE_HD CellIndex cell_at(const Vec3d& there) const {
    const Vec3d at = there / texel_before;
    typename Surface::Cursor cursor(before);
    return cursor.find({int(std::floor(at.x)), int(std::floor(at.y)), int(std::floor(at.z))}).cell;
  }
};

/// Takes what the source has; what has none keeps its own.
template <class Value>
struct TakeFromSource {
  const CellIndex* source;
  const Value* from;
  Value* to;
  NACRE_HD void operator()(std::int64_t s) const {
    if (source[s] != no_cell) to[s] = from[source[s]];
  }
};

/// 1 where a cell has a source.
struct HasSource {
  const CellIndex* source;
  NACRE_HD std::uint64_t operator()(std::int64_t s) const { return source[s] != no_cell ? 1 : 0; }
};

}  // namespace nacre
