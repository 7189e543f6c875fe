// Nacre: the refined grid and its neighbour index from a closest-point grid (sec. 5.2.1).
#pragma once

#include "compute/device/executor.hpp"
#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/refined_grid.hpp"

namespace nacre {

/// A refined grid and who owns its arrays.
struct RefinedGrid {
  int refine = 4;
  std::uint64_t cells = 0;          ///< stored: blocks * R^3
  std::uint32_t surface_cells = 0;  ///< those that the surface passes through
  Array<std::uint32_t> block, texel, place, block_cell, seed_triangle, neighbour;
  Array<Float4> seed;

  RefinedGridView view(const ClosestPointGridView& grid) const {
    return {grid,
            refine,
            1.0f / float(refine),
            Divider(refine),
            block.data(),
            texel.data(),
            place.data(),
            block_cell.data(),
            seed.data(),
            seed_triangle.data(),
            neighbour.data()};
  }

  std::uint64_t bytes() const {
    return block.bytes() + texel.bytes() + place.bytes() + block_cell.bytes() + seed_triangle.bytes() +
           neighbour.bytes() + seed.bytes();
  }
};

namespace detail {

/// How far from the surface, in texture cells, a cell still knows its surface cell: what a chord of a pathline, a
/// linear look-up and a neighbour need.
inline constexpr float extension_reach = 2.3f;

/// A closest-point cell gets a block where one of its texture cells is within reach.
struct NeedsBlock {
  const Float4* offset;
  float reach;
  std::uint32_t* flag;
  NACRE_HD void operator()(std::int64_t i) const { flag[i] = offset[i].w <= reach ? 1 : 0; }
};

struct NumberBlocks {
  const Float4* offset;
  float reach;
  std::uint32_t* number;  // in: exclusive scan of the flags; out: block or none
  std::uint32_t* block_cell;
  NACRE_HD void operator()(std::int64_t i) const {
    if (offset[i].w <= reach)
      block_cell[number[i]] = std::uint32_t(i);
    else
      number[i] = none;
  }
};

/// Flags every texture cell that the triangle touches.
struct MarkSurface {
  MeshView mesh;
  RefinedGridView texture;
  std::uint32_t* texel;
  NACRE_HD void operator()(std::int64_t t) const {
    const Int3 dims = texture.grid.dims() * Int3(texture.refine);
    for_cells_near(mesh.corners(std::uint32_t(t)) * double(texture.refine), 0.0, dims, [&](const Int3& cell) {
      const std::uint32_t at = texture.entry(cell);
      if (at != none) relaxed_store(texel + at, 1);
    });
  }
};

/// Numbers the surface cells and finds each one's exact closest point among the triangles in reach.
struct NumberSurface {
  MeshView mesh;
  RefinedGridView texture;
  const std::uint32_t* number;
  std::uint32_t* texel;
  std::uint32_t* place;
  Float4* seed;
  std::uint32_t* seed_triangle;

  NACRE_HD void operator()(std::int64_t i) const {
    if (texel[i] == 0) {
      texel[i] = none;
      return;
    }
    const std::uint32_t s = number[i];
    texel[i] = s;
    place[s] = std::uint32_t(i);
    const double scale = 1.0 / texture.refine;
    const Vec3d centre = (Vec3d(texture.texel_cell(std::uint32_t(i))) + Vec3d(0.5)) * scale;
    const double reach = 0.8661 * scale;  // the surface passes through the cell
    const Int3 home = floor_cell(Vec3f(centre));
    double best = reach * reach;
    search(home, centre, s, best);
    const Int3 first = floor_cell(Vec3f(centre - Vec3d(reach))), last = floor_cell(Vec3f(centre + Vec3d(reach)));
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          const Int3 cell{x, y, z};
          const Vec3d low(cell), away = max(low, min(low + Vec3d(1.0), centre)) - centre;
          if (!(cell == home) && dot(away, away) < best) search(cell, centre, s, best);
        }
  }

  NACRE_HD void search(const Int3& cell, const Vec3d& centre, std::uint32_t s, double& best) const {
    const ClosestPointGridView& grid = texture.grid;
    const std::uint32_t at = grid.address(cell);
    if (at == none) return;
    for (std::uint32_t k = grid.touch_start[at]; k < grid.touch_start[at + 1]; ++k) {
      const std::uint32_t t = grid.touch_triangle[k];
      const Vec3d o = closest_point(mesh.corners(t), centre) - centre;
      const double d = dot(o, o);
      if (d < best || (d == best && t < seed_triangle[s])) {
        best = d;
        const Vec3f offset(o * double(texture.refine));
        seed[s] = {offset.x, offset.y, offset.z, 0};
        seed_triangle[s] = t;
      }
    }
  }
};

/// Tells the cells beside the surface which surface cell holds their closest point, interpolated linearly (its error is
/// far below a texture cell where the surface is smooth) and snapped to the nearest surface cell where it is not.
struct ExtendSurface {
  RefinedGridView texture;
  std::uint32_t* texel;

  NACRE_HD bool is_surface(const Int3& cell, std::uint32_t& value) const {
    const std::uint32_t at = texture.entry(cell);
    if (at == none) return false;
    value = texel[at];
    return (value & RefinedGridView::extended) == 0;
  }

  NACRE_HD void operator()(std::int64_t i) const {
    if (texel[i] != none) return;
    const Vec3f centre = cell_centre(texture.texel_cell(std::uint32_t(i)));
    const float scale = float(texture.refine);
    const ClosestPointGridView& grid = texture.grid;
    const std::uint32_t at = texture.block_cell[std::uint32_t(i) / texture.cells_per_block()];
    if (grid.offset[at].w * scale > extension_reach + 0.8661f * scale) return;
    Lanes offset;
    if (!interpolate_linear(grid, grid.offset, centre / scale, offset)) return;
    const Vec3f away = xyz(offset) * scale;
    if (dot(away, away) > extension_reach * extension_reach) return;
    const Vec3f p = centre + away;
    const Int3 home = floor_cell(p);
    std::uint32_t found = none;
    if (!is_surface(home, found)) {
      float best = 1e30f;
      std::uint32_t nearest = none;
      for (int k = 0; k < 27; ++k) {
        const Int3 cell = home + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        const Vec3f d = cell_centre(cell) - p;
        if (dot(d, d) < best && is_surface(cell, found)) {
          best = dot(d, d);
          nearest = found;
        }
      }
      found = nearest;
    }
    if (found != none) relaxed_store(texel + i, found | RefinedGridView::extended);
  }
};

/// The neighbour index: which surface cell holds the closest point of each of the six neighbours (Fig. 5.4).
struct FindNeighbours {
  RefinedGridView texture;
  std::uint32_t* neighbour;
  NACRE_HD void operator()(std::int64_t i) const {
    const auto s = std::uint32_t(i);
    const Int3 cell = texture.cell(s);
    for (int k = 0; k < 6; ++k) {
      Int3 next = cell;
      next[k / 2] += k % 2 ? 1 : -1;
      const std::uint32_t n = texture.surface_cell(next);
      neighbour[6 * i + k] = n == none ? s : n;
    }
  }
};

}  // namespace detail

/// Subdivides the cells of `coarse` near the surface into `refine`^3 texture cells and numbers those that a triangle
/// touches, all of them however large the triangle. Arrays are permanent in the executor's arena.
template <class Backend>
RefinedGrid build_refined_grid(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles,
                               const ClosestPointGrid& coarse, int refine) {
  Arena& arena = exec.arena();
  const ClosestPointGridView grid = coarse.view();
  const float reach = 0.8661f + detail::extension_reach / float(refine);
  RefinedGrid fine;
  fine.refine = refine;
  fine.block = arena.permanent<std::uint32_t>(coarse.cells);
  exec.for_each(coarse.cells, detail::NeedsBlock{grid.offset, reach, fine.block.data()});
  const std::uint32_t blocks = exec.exclusive_scan(fine.block.data(), fine.block.data(), coarse.cells);
  fine.cells = std::uint64_t(blocks) * refine * refine * refine;
  if (fine.cells >= RefinedGridView::extended)
    throw Error("the texture grid is too fine", "over 2^31 cells", "lower --resolution");
  fine.block_cell = arena.permanent<std::uint32_t>(blocks);
  exec.for_each(coarse.cells, detail::NumberBlocks{grid.offset, reach, fine.block.data(), fine.block_cell.data()});

  fine.texel = arena.permanent<std::uint32_t>(fine.cells);
  fine.texel.fill_bytes(0);
  exec.for_each(triangles, detail::MarkSurface{mesh, fine.view(grid), fine.texel.data()});
  Arena::Scope scope(arena);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(fine.cells);
  fine.surface_cells = exec.exclusive_scan(fine.texel.data(), number.data(), fine.cells);
  fine.place = arena.permanent<std::uint32_t>(fine.surface_cells);
  fine.seed = arena.permanent<Float4>(fine.surface_cells);
  fine.seed_triangle = arena.permanent<std::uint32_t>(fine.surface_cells);
  exec.for_each(fine.cells, detail::NumberSurface{mesh, fine.view(grid), number.data(), fine.texel.data(),
                                                  fine.place.data(), fine.seed.data(), fine.seed_triangle.data()});
  exec.for_each(fine.cells, detail::ExtendSurface{fine.view(grid), fine.texel.data()});
  fine.neighbour = arena.permanent<std::uint32_t>(6 * std::size_t(fine.surface_cells));
  exec.for_each(fine.surface_cells, detail::FindNeighbours{fine.view(grid), fine.neighbour.data()});
  return fine;
}

}  // namespace nacre
