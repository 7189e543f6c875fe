// Nacre: how kernels find the surface cell of a position, on the grid and on the octree of bricks.
#pragma once

#include "compute/embedding/band.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/refined_grid.hpp"

namespace nacre {

/// A surface cell that was found for a cell of space.
struct NearSurfaceCell {
  CellIndex cell = no_cell;
  bool direct = false;  ///< it is that cell itself, not the one that holds its closest point
};

/// The closest point of a surface cell, from its centre, in texture cells, and the triangle that it lies on.
struct SurfaceFoot {
  Vec3f offset;
  std::uint32_t triangle;
};

/// The surface cells of the grid.
struct GridSurface {
  RefinedGridView texture;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex s, const Int3&) const {
    const Float4 offset = texture.seed[s];
    return {{offset.x, offset.y, offset.z}, texture.seed_triangle[s]};
  }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const GridSurface& surface) : cursor_(surface.texture) {}
    NACRE_HD_INLINE NearSurfaceCell find(const Int3& cell) {
      const std::uint32_t value = cursor_.texel(cell);
      if (value == none) return {};
      return {value & ~RefinedGridView::extended, !(value & RefinedGridView::extended)};
    }

   private:
    SurfaceCellCursor cursor_;
  };
};

/// The same on the octree of bricks.
struct BrickSurface {
  BrickOctreeView view;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex, const Int3& position) const {
    const CellPoint point = view.point[BrickOctreeView::Cursor(view).find(position)];
    return {point.offset(view.quantum), point.triangle};
  }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const BrickSurface& surface) : view_(surface.view), cursor_(view_) {}
    /// Begins where another cursor is.
    NACRE_HD_INLINE Cursor(const BrickSurface& surface, const BrickOctreeView::Cursor& cursor)
        : view_(surface.view), cursor_(cursor) {}
    NACRE_HD_INLINE NearSurfaceCell find(const Int3& cell) {
      const CellIndex at = cursor_.find_surface(cell);
      if (at != no_cell) return {at, true};
      const CellIndex beside = cursor_.find(cell);
      if (beside == no_cell) return {};
      return {cursor_.find_surface(closest_point_of(cell, view_.point[beside], view_.quantum).cell()), false};
    }

   private:
    const BrickOctreeView& view_;
    BrickOctreeView::Cursor cursor_;
  };
};

/// Runs `kernel(surface_cell, position)` on all surface cells, of the grid or of the octree.
template <class Kernel>
struct OnGridSurface {
  RefinedGridView texture;
  Kernel kernel;
  NACRE_HD void operator()(std::int64_t i) const { kernel(CellIndex(i), texture.cell(std::uint32_t(i))); }
};

template <class Kernel>
struct OnBrickSurface {
  Kernel kernel;
  NACRE_HD void operator()(CellIndex s, CellIndex, const Int3& position, BrickOctreeView::Cursor&) const {
    kernel(s, position);
  }
};

template <class Backend, class Kernel>
void for_each_surface_cell_of(Executor<Backend>& exec, const GridSurface& surface, std::int64_t n,
                              const Kernel& kernel) {
  exec.for_each(n, OnGridSurface<Kernel>{surface.texture, kernel});
}

template <class Backend, class Kernel>
void for_each_surface_cell_of(Executor<Backend>& exec, const BrickSurface& surface, std::int64_t,
                              const Kernel& kernel) {
  for_each_surface_cell(exec, surface.view, OnBrickSurface<Kernel>{kernel});
}

}  // namespace nacre
