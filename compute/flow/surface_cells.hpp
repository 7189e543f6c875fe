// Nacre: how kernels find the surface cell of a position, on the grid and on the octree of bricks.
#pragma once

#include <type_traits>
#include <utility>

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

/// The same for one cell or several. Where `found` is not set, `cell` is one that exists and the rest says nothing.
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
      const typename Wide::Mask found = value != -1;
      return {select(found, value & ~std::int32_t(RefinedGridView::extended), Wide::all(0)), found, value >= 0};
    }

   private:
    SurfaceCellCursors<Wide> cursor_;
  };
};

using GridSurface = GridSurfaceOf<Widest>;

/// Numbers of as many surface cells as `Lanes` has; 64 bits each.
template <class Lanes>
struct CellIndices {
  CellIndex cell[Lanes::lanes];
  NACRE_HD_INLINE CellIndex operator[](int lane) const { return cell[lane]; }
};

/// The same on the octree of bricks: cells are looked up one by one.
template <class Lanes>
struct BrickSurfaceOf {
  BrickOctreeView view;
  using Wide = Lanes;
  using Index = std::conditional_t<Lanes::lanes == 1, CellIndex, CellIndices<Lanes>>;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex, const Int3& position) const {
    const CellPoint point = view.point[BrickOctreeView::Cursor(view).find(position)];
    return {point.offset(view.quantum), point.triangle};
  }

  /// The band is too thin to say more than its surface cells do.
  NACRE_HD_INLINE bool foot_near(const Vec3d&, Vec3d&) const { return false; }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const BrickSurfaceOf& surface) : view_(surface.view), cursor_(view_) {}
    /// Begins where another cursor is.
    NACRE_HD_INLINE Cursor(const BrickSurfaceOf& surface, const BrickOctreeView::Cursor& cursor)
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
    NACRE_HD_INLINE explicit WideCursor(const BrickSurfaceOf& surface) : WideCursor(surface, Lane()) {}

    NACRE_HD_INLINE NearSurfaceCells<Wide, Index> find(const Vec3<typename Wide::Int>& cell, typename Wide::Mask mask) {
      if constexpr (Wide::lanes == 1) {
        const NearSurfaceCell near = mask ? cursor_[0].find(cell) : NearSurfaceCell{};
        const bool found = near.cell != no_cell;
        return {found ? near.cell : 0, found, near.direct};
      } else {
        NearSurfaceCells<Wide, Index> all{};
        for (int lane = 0; lane < Wide::lanes; ++lane) {
          if (!mask[lane]) continue;
          const NearSurfaceCell near = cursor_[lane].find({cell.x[lane], cell.y[lane], cell.z[lane]});
          if (near.cell == no_cell) continue;
          all.cell.cell[lane] = near.cell;
          all.found[lane] = -1;
          all.direct[lane] = -int(near.direct);
        }
        return all;
      }
    }

   private:
    using Lane = std::make_integer_sequence<int, Wide::lanes>;
    template <int... lane>
    NACRE_HD_INLINE WideCursor(const BrickSurfaceOf& surface, std::integer_sequence<int, lane...>)
        : cursor_{(void(lane), Cursor(surface))...} {}

    Cursor cursor_[Wide::lanes];
  };
};

using BrickSurface = BrickSurfaceOf<Widest>;

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

template <class Backend, class Lanes, class Kernel>
void for_each_surface_cell_of(Executor<Backend>& exec, const BrickSurfaceOf<Lanes>& surface, std::int64_t,
                              const Kernel& kernel) {
  for_each_surface_cell(exec, surface.view, OnBrickSurface<Kernel>{kernel});
}

/// Where `store_on_surface` puts its results: in an array.
template <class Value>
struct ToArray {
  Value* values;
  NACRE_HD_INLINE void operator()(CellIndex s, const Value& value) const { values[s] = value; }
};
template <class Value>
ToArray(Value*) -> ToArray<Value>;

/// As many surface cells of the grid as `Wide` has lanes, in the order of their numbers.
template <class Wide>
struct GridCells {
  typename Wide::Int number;
  Vec3<typename Wide::Int> position;
  int count;  ///< those behind are the last one again

  /// The cells from `first` on, of `n` in all.
  NACRE_HD_INLINE GridCells(const RefinedGridView& texture, std::int64_t first, std::int64_t n)
      : count(int(n - first < Wide::lanes ? n - first : Wide::lanes)) {
    if constexpr (Wide::lanes == 1) {
      number = std::int32_t(first);
      position = texture.cell(std::uint32_t(first));
    } else {
      std::uint32_t block = none;
      Int3 corner;
      for (int lane = 0; lane < Wide::lanes; ++lane) {
        const auto s = std::uint32_t(first + (lane < count ? lane : count - 1));
        const std::uint32_t at = texture.position[s], b = texture.divide.cubes(at);
        if (b != block) block = b, corner = texture.corner(b);  // most have the one of the cell before
        const Int3 cell = corner + texture.divide.cell_of_cube(int(at - b * texture.cells_per_block()));
        number[lane] = std::int32_t(s);
        position.x[lane] = cell.x, position.y[lane] = cell.y, position.z[lane] = cell.z;
      }
    }
  }
};

/// Calls `store(s, kernel(surface_cells, positions)[s])` for all surface cells, computing as many at a time as the
/// surface allows.
template <class Wide, class Kernel, class Store>
struct StoreOnGridSurface {
  RefinedGridView texture;
  std::int64_t n;
  Kernel kernel;
  Store store;

  NACRE_HD void operator()(std::int64_t packet) const {
    const GridCells<Wide> cells(texture, packet * Wide::lanes, n);
    const auto value = kernel(cells.number, cells.position);
    for (int lane = 0; lane < cells.count; ++lane) store(CellIndex(packet * Wide::lanes + lane), element(value, lane));
  }
};

/// The same on the octree: those of a brick side by side.
template <class Wide, class Kernel, class Store>
struct StoreOnBrickSurface {
  BrickOctreeView view;
  Kernel kernel;
  Store store;
  std::size_t scratch_bytes() const { return 0; }

  NACRE_HD void operator()(Team& team, std::int64_t item) const {
    if constexpr (Wide::lanes == 1) {
      view.each_surface_cell(team, item, [&](CellIndex s, CellIndex, const Int3& position, BrickOctreeView::Cursor&) {
        store(s, element(kernel(s, position), 0));
      });
    } else {
      CellIndices<Wide> home;
      Vec3<typename Wide::Int> position;
      int count = 0;
      const auto compute = [&] {
        for (int lane = count; lane < Wide::lanes; ++lane) {  // the last one again
          home.cell[lane] = home.cell[count - 1];
          position.x[lane] = position.x[count - 1], position.y[lane] = position.y[count - 1];
          position.z[lane] = position.z[count - 1];
        }
        const auto value = kernel(home, position);
        for (int lane = 0; lane < count; ++lane) store(home.cell[lane], element(value, lane));
        count = 0;
      };
      view.each_surface_cell(team, item, [&](CellIndex s, CellIndex, const Int3& at, BrickOctreeView::Cursor&) {
        home.cell[count] = s;
        position.x[count] = at.x, position.y[count] = at.y, position.z[count] = at.z;
        if (++count == Wide::lanes) compute();
      });
      if (count > 0) compute();
    }
  }
};

template <class Backend, class Lanes, class Kernel, class Store>
void store_on_surface(Executor<Backend>& exec, const GridSurfaceOf<Lanes>& surface, std::int64_t n,
                      const Kernel& kernel, const Store& store) {
  constexpr int lanes = Lanes::lanes;
  exec.for_each((n + lanes - 1) / lanes, StoreOnGridSurface<Lanes, Kernel, Store>{surface.texture, n, kernel, store});
}

template <class Backend, class Lanes, class Kernel, class Store>
void store_on_surface(Executor<Backend>& exec, const BrickSurfaceOf<Lanes>& surface, std::int64_t, const Kernel& kernel,
                      const Store& store) {
  exec.for_each_team(surface.view.items(), StoreOnBrickSurface<Lanes, Kernel, Store>{surface.view, kernel, store});
}

}  // namespace nacre
