// Nacre: the refined grid and its neighbour index from a closest-point grid (sec. 5.2.1).
#pragma once

#include "compute/device/executor.hpp"
#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/refined_grid.hpp"
#include "compute/math/bits.hpp"

namespace nacre {

/// A refined grid and who owns its arrays.
struct RefinedGrid {
  int refine = 4;
  std::uint64_t cells = 0;          ///< stored: blocks * R^3
  std::uint32_t surface_cells = 0;  ///< those that the surface passes through
  Array<std::uint32_t> block, texel, position, block_cell, first_surface_cell, seed_triangle, neighbour;
  Array<Float4> seed;

  RefinedGridView view(const ClosestPointGridView& grid) const {
    return {grid,
            refine,
            1.0f / float(refine),
            Divider(refine),
            block.data(),
            texel.data(),
            position.data(),
            block_cell.data(),
            first_surface_cell.data(),
            seed.data(),
            seed_triangle.data(),
            neighbour.data()};
  }

  std::uint64_t bytes() const {
    return block.bytes() + texel.bytes() + position.bytes() + block_cell.bytes() + first_surface_cell.bytes() +
           seed_triangle.bytes() + neighbour.bytes() + seed.bytes();
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

/// How many surface cells a block has.
struct CountSurface {
  int cells;  // of a block
  const std::uint32_t* texel;
  std::uint32_t* count;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, std::int64_t b) const {
    const std::uint32_t n = team.sum(cells, 0u, [&](int k) { return texel[b * cells + k]; });
    if (team.first()) count[b] = n;
  }
};

/// Numbers the surface cells of a block and finds each one's exact closest point among the triangles in reach.
struct NumberSurface {
  MeshView mesh;
  RefinedGridView texture;
  std::uint32_t* texel;
  std::uint32_t* position;
  Float4* seed;
  std::uint32_t* seed_triangle;

  static constexpr int words = 8 * 8 * 8 / 64;
  std::size_t scratch_bytes() const { return words * sizeof(std::uint64_t); }

  NACRE_HD void operator()(Team& team, std::int64_t b) const {
    auto* const mask = reinterpret_cast<std::uint64_t*>(team.scratch());
    const int cells = texture.cells_per_block();
    const auto begin = std::uint32_t(b) * std::uint32_t(cells);
    team.each((cells + 63) / 64, [&](int w) {
      mask[w] = 0;
      for (int k = 0; k < 64 && 64 * w + k < cells; ++k) mask[w] |= std::uint64_t(texel[begin + 64 * w + k]) << k;
    });
    team.each(cells, [&](int k) {
      const std::uint64_t own = mask[k / 64], bit = std::uint64_t(1) << k % 64;
      texel[begin + k] = none;
      if (!(own & bit)) return;
      std::uint32_t s = texture.first_surface_cell[b] + count_bits(own & (bit - 1));
      for (int w = 0; w < k / 64; ++w) s += count_bits(mask[w]);
      texel[begin + k] = s;
      position[s] = begin + k;
      find_seed(s);
    });
  }

 private:
  struct Nearest {
    double squared;
    Vec3d offset;
    std::uint32_t triangle = none;
  };

  NACRE_HD void find_seed(std::uint32_t s) const {
    const double scale = 1.0 / texture.refine;
    const Vec3d centre = (Vec3d(texture.cell(s)) + Vec3d(0.5)) * scale;
    const double reach = 0.8661 * scale;  // the surface passes through the cell
    const Int3 home = floor_cell(Vec3f(centre));
    Nearest nearest{reach * reach, {}};
    search(home, centre, nearest);
    const Int3 low = floor_cell(Vec3f(centre - Vec3d(reach))), high = floor_cell(Vec3f(centre + Vec3d(reach)));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const Int3 cell{x, y, z};
          const Vec3d corner(cell), away = max(corner, min(corner + Vec3d(1.0), centre)) - centre;
          if (!(cell == home) && dot(away, away) < nearest.squared) search(cell, centre, nearest);
        }
    const Vec3f offset(nearest.offset * double(texture.refine));
    seed[s] = {offset.x, offset.y, offset.z, 0};
    seed_triangle[s] = nearest.triangle;
  }

  NACRE_HD void search(const Int3& cell, const Vec3d& centre, Nearest& nearest) const {
    const ClosestPointGridView& grid = texture.grid;
    const std::uint32_t at = grid.address(cell);
    if (at == none) return;
    for (std::uint32_t k = grid.touch_start[at]; k < grid.touch_start[at + 1]; ++k) {
      const std::uint32_t t = grid.touch_triangle[k];
      if (t == nearest.triangle) continue;
      const Corners corners = mesh.corners(t);
      const Vec3d low = min(corners.a, min(corners.b, corners.c)), high = max(corners.a, max(corners.b, corners.c));
      const Vec3d to_box = max(low, min(high, centre)) - centre;
      if (dot(to_box, to_box) > nearest.squared) continue;
      const Vec3d o = closest_point(corners, centre) - centre;
      const double d = dot(o, o);
      if (d < nearest.squared || (d == nearest.squared && t < nearest.triangle)) nearest = {d, o, t};
    }
  }
};

/// Tells the cells beside the surface which surface cell holds their closest point, interpolated linearly (its error is
/// far below a texture cell where the surface is smooth) and snapped to the nearest surface cell where it is not. A
/// team looks up what lies around a block once for all of its cells; coordinates count from the block's corner.
struct ExtendSurface {
  RefinedGridView texture;
  std::uint32_t* texel;

  struct Scratch {  // of the 27 closest-point cells around, the block's own in the middle
    Int3 corner;
    Float4 offset[27];  // w: `missing` where there is no cell
    std::uint32_t block[27];
  };
  static constexpr float missing = 1e30f;
  std::size_t scratch_bytes() const { return sizeof(Scratch); }

  NACRE_HD void operator()(Team& team, std::int64_t b) const {
    Scratch& around = *reinterpret_cast<Scratch*>(team.scratch());
    const ClosestPointGridView& grid = texture.grid;
    const Int3 middle = grid.cell(texture.block_cell[b]);
    team.each(27, [&](int k) {
      const std::uint32_t at = grid.address(middle + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
      around.offset[k] = at == none ? Float4{0, 0, 0, missing} : grid.offset[at];
      around.block[k] = at == none ? none : texture.block[at];
      if (k == 0) around.corner = middle * Int3(texture.refine);
    });
    team.each(texture.cells_per_block(), [&](int k) {
      std::uint32_t& value = texel[b * texture.cells_per_block() + k];
      if (value != none) return;
      const int row = texture.divide(k), z = texture.divide(row);
      const std::uint32_t found = closest(around, {k - row * texture.refine, row - z * texture.refine, z});
      if (found != none) relaxed_store(&value, found | RefinedGridView::extended);
    });
  }

 private:
  /// The surface cell that holds the closest point of a cell of the block, or the nearest one to that; `none` out of
  /// reach.
  NACRE_HD std::uint32_t closest(const Scratch& around, const Int3& cell) const {
    const Vec3f centre = cell_centre(cell), f = centre * texture.inverse_refine - Vec3f(0.5f);
    const Int3 first{f.x < 0 ? 0 : 1, f.y < 0 ? 0 : 1, f.z < 0 ? 0 : 1};
    LinearCells cells;
    cells.f = f + Vec3f(Int3(1) - first);
    for (int k = 0; k < 8; ++k)
      cells.at[k] = std::uint32_t(((k >> 2) + first.z) * 9 + ((k >> 1 & 1) + first.y) * 3 + (k & 1) + first.x);
    const Float4 offset = store(cells.interpolate(around.offset) * float(texture.refine));
    const Vec3f away{offset.x, offset.y, offset.z};
    if (offset.w > 1e-3f * missing || dot(away, away) > extension_reach * extension_reach) return none;
    const Vec3f p = centre + away;
    const Int3 home = floor_cell(p);
    std::uint32_t found = none;
    if (is_surface(around, home, found)) return found;
    float best = 1e30f;
    std::uint32_t nearest = none;
    for (int k = 0; k < 27; ++k) {
      const Int3 beside = home + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const Vec3f d = cell_centre(beside) - p;
      if (dot(d, d) < best && is_surface(around, beside, found)) {
        best = dot(d, d);
        nearest = found;
      }
    }
    return nearest;
  }

  NACRE_HD bool is_surface(const Scratch& around, const Int3& cell, std::uint32_t& value) const {
    const Int3 outer = texture.outer(cell), position = outer + Int3(1);
    std::uint32_t at = none;
    if (unsigned(position.x) < 3 && unsigned(position.y) < 3 && unsigned(position.z) < 3) {
      const std::uint32_t b = around.block[(position.z * 3 + position.y) * 3 + position.x];
      if (b != none) at = texture.entry_in(b, cell, outer);
    } else {
      at = texture.entry(around.corner + cell);  // a block of few cells
    }
    if (at == none) return false;
    value = relaxed_load(texel + at);  // a team of the block beside may be extending it
    return (value & RefinedGridView::extended) == 0;
  }
};

/// The neighbour index: which surface cell holds the closest point of each of the six neighbours (Fig. 5.4).
struct FindNeighbours {
  RefinedGridView texture;
  std::uint32_t* neighbour;
  NACRE_HD void operator()(std::int64_t i) const {
    const auto s = std::uint32_t(i);
    const std::uint32_t own = texture.position[s] / texture.cells_per_block();
    const Int3 cell = texture.cell(s), home = texture.outer(cell);
    for (int k = 0; k < 6; ++k) {
      Int3 next = cell;
      next[k / 2] += k % 2 ? 1 : -1;
      const Int3 outer = texture.outer(next);
      const std::uint32_t b = outer == home ? own : texture.block_of(outer);
      const std::uint32_t n = b == none ? none : texture.surface_cell_at(texture.entry_in(b, next, outer));
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
    throw Error("the texture grid is too fine", "over 2^31 cells", "lower `resolution`");
  fine.block_cell = arena.permanent<std::uint32_t>(blocks);
  exec.for_each(coarse.cells, detail::NumberBlocks{grid.offset, reach, fine.block.data(), fine.block_cell.data()});

  fine.texel = arena.permanent<std::uint32_t>(fine.cells);
  fine.texel.fill_bytes(0);
  exec.next_is(0.35, 0.5);
  exec.for_each(triangles, detail::MarkSurface{mesh, fine.view(grid), fine.texel.data()});
  fine.first_surface_cell = arena.permanent<std::uint32_t>(blocks + 1);
  std::uint32_t* const first = fine.first_surface_cell.data();
  fine.first_surface_cell.fill_bytes(0);
  exec.for_each_team(blocks, detail::CountSurface{refine * refine * refine, fine.texel.data(), first});
  fine.surface_cells = exec.exclusive_scan(first, first, blocks + 1);
  fine.position = arena.permanent<std::uint32_t>(fine.surface_cells);
  fine.seed = arena.permanent<Float4>(fine.surface_cells);
  fine.seed_triangle = arena.permanent<std::uint32_t>(fine.surface_cells);
  exec.next_is(0.5, 0.75);
  exec.for_each_team(blocks, detail::NumberSurface{mesh, fine.view(grid), fine.texel.data(), fine.position.data(),
                                                   fine.seed.data(), fine.seed_triangle.data()});
  exec.next_is(0.75, 0.9);
  exec.for_each_team(blocks, detail::ExtendSurface{fine.view(grid), fine.texel.data()});
  fine.neighbour = arena.permanent<std::uint32_t>(6 * std::size_t(fine.surface_cells));
  exec.next_is(0.9, 1);
  exec.for_each(fine.surface_cells, detail::FindNeighbours{fine.view(grid), fine.neighbour.data()});
  return fine;
}

}  // namespace nacre
