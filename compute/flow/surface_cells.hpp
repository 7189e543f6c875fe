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

/// The same for one cell or several. Where `found` is not set, the rest says nothing.
template <class Wide, class Index>
struct NearSurfaceCells {
  Index cell;
  typename Wide::Mask found, direct;
};

/// The surface cells of the grid. Kernels that can do so compute with as many of them at a time as `Lanes` has.
template <class Lanes>
struct GridSurfaceOf {
  RefinedGridView texture;
  using Wide = Lanes;
  using Index = typename Wide::Int;  ///< their numbers

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex s, const Int3&) const {
    const Float4 offset = texture.seed[s];
    return {{offset.x, offset.y, offset.z}, texture.seed_triangle[s]};
  }

  /// About the closest point of a position, both in texture cells: those that the cells of the grid around it know,
  /// interpolated. Off the surface where these lie on different sheets; false where the grid does not reach.
  NACRE_HD_INLINE bool foot_near(const Vec3d& position, Vec3d& foot) const {
    const Vec3d in_grid = position * double(texture.inverse_refine);
    nacre::Lanes offset;
    if (!interpolate_linear(texture.grid, texture.grid.offset, Vec3f(in_grid), offset)) return false;
    foot = (in_grid + Vec3d(xyz(offset))) * double(texture.refine);
    return true;
  }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const GridSurfaceOf& surface) : cursor_(surface.texture) {}
    NACRE_HD_INLINE NearSurfaceCell find(const Int3& cell) {
      const std::uint32_t value = cursor_.texel(cell);
      if (value == none) return {};
      return {value & ~RefinedGridView::extended, !(value & RefinedGridView::extended)};
    }

   private:
    SurfaceCellCursor cursor_;
  };

  class WideCursor {
   public:
    NACRE_HD_INLINE explicit WideCursor(const GridSurfaceOf& surface) : cursor_(surface.texture) {}
    NACRE_HD_INLINE NearSurfaceCells<Wide, Index> find(const Vec3<typename Wide::Int>& cell, typename Wide::Mask mask) {
      const Index value = cursor_.texel(cell, mask);
      return {value & ~std::int32_t(RefinedGridView::extended), value != -1, value >= 0};
    }

   private:
    SurfaceCellCursors<Wide> cursor_;
  };
};

using GridSurface = GridSurfaceOf<Widest>;

/// The same on the octree of bricks.
struct BrickSurface {
  BrickOctreeView view;
  using Wide = Single;
  using Index = CellIndex;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex, const Int3& position) const {
    const CellPoint point = view.point[BrickOctreeView::Cursor(view).find(position)];
    return {point.offset(view.quantum), point.triangle};
  }

  /// The band is too thin to say more than its surface cells do.
  NACRE_HD_INLINE bool foot_near(const Vec3d&, Vec3d&) const { return false; }

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

  class WideCursor {
   public:
    NACRE_HD_INLINE explicit WideCursor(const BrickSurface& surface) : cursor_(surface) {}
    NACRE_HD_INLINE NearSurfaceCells<Wide, Index> find(const Int3& cell, bool mask) {
      const NearSurfaceCell near = mask ? cursor_.find(cell) : NearSurfaceCell{};
      return {near.cell, near.cell != no_cell, near.direct};
    }

   private:
    Cursor cursor_;
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

template <class Backend, class Lanes, class Kernel>
void for_each_surface_cell_of(Executor<Backend>& exec, const GridSurfaceOf<Lanes>& surface, std::int64_t n,
                              const Kernel& kernel) {
  exec.for_each(n, OnGridSurface<Kernel>{surface.texture, kernel});
}

template <class Backend, class Kernel>
void for_each_surface_cell_of(Executor<Backend>& exec, const BrickSurface& surface, std::int64_t,
                              const Kernel& kernel) {
  for_each_surface_cell(exec, surface.view, OnBrickSurface<Kernel>{kernel});
}

/// Stores `kernel(surface_cells, positions)` of all surface cells in `result`, computing as many at a time as the
/// surface allows.
template <class Wide, class Kernel>
struct StoreOnGridSurface {
  RefinedGridView texture;
  std::int64_t n;
  Kernel kernel;
  float* result;

  NACRE_HD void operator()(std::int64_t packet) const {
    typename Wide::Int home;
    Vec3<typename Wide::Int> position;
    const std::int64_t first = packet * Wide::lanes, count = n - first < Wide::lanes ? n - first : Wide::lanes;
    if constexpr (Wide::lanes == 1) {
      home = std::int32_t(first);
      position = texture.cell(std::uint32_t(first));
      result[first] = kernel(home, position);
    } else {
      for (int lane = 0; lane < Wide::lanes; ++lane) {
        const auto s = std::uint32_t(first + (lane < count ? lane : count - 1));
        const Int3 cell = texture.cell(s);
        home[lane] = std::int32_t(s);
        position.x[lane] = cell.x, position.y[lane] = cell.y, position.z[lane] = cell.z;
      }
      const typename Wide::Float value = kernel(home, position);
      for (int lane = 0; lane < count; ++lane) result[first + lane] = value[lane];
    }
  }
};

template <class Kernel>
struct StoreOnBrickSurface {
  Kernel kernel;
  float* result;
  NACRE_HD void operator()(CellIndex s, const Int3& position) const { result[s] = kernel(s, position); }
};

template <class Backend, class Lanes, class Kernel>
void store_on_surface(Executor<Backend>& exec, const GridSurfaceOf<Lanes>& surface, std::int64_t n,
                      const Kernel& kernel, float* result) {
  constexpr int lanes = Lanes::lanes;
  exec.for_each((n + lanes - 1) / lanes, StoreOnGridSurface<Lanes, Kernel>{surface.texture, n, kernel, result});
}

template <class Backend, class Kernel>
void store_on_surface(Executor<Backend>& exec, const BrickSurface& surface, std::int64_t n, const Kernel& kernel,
                      float* result) {
  for_each_surface_cell_of(exec, surface, n, StoreOnBrickSurface<Kernel>{kernel, result});
}

}  // namespace nacre
