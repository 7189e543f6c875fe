// Nacre: the sparse refined grid as kernels see it (thesis, sec. 5.2.1): texture cells on and beside the surface.
#pragma once

#include <cstdint>

#include "compute/embedding/closest_point_grid.hpp"

namespace nacre {

/// A cell of the closest-point grid has R^3 texture cells. A cell that the surface passes through is a surface cell and
/// has a number 0..surface_cells-1, in the order of the bricks; values are stored in arrays of that length. A cell
/// within two cells of the surface stores the surface cell that contains its closest point, so that a value can be
/// looked up there too (its closest-point extension). All coordinates here are in texture cells.
struct RefinedGridView {
  static constexpr std::uint32_t extended = 0x80000000u;  ///< set in `texel` if the cell is beside the surface

  ClosestPointGridView grid;
  int refine = 4;  ///< R, 1..8
  float inverse_refine = 0.25f;
  Divider divide{4};                          ///< by refine
  const std::uint32_t* block = nullptr;       ///< per closest-point cell: its block of R^3 texture cells, or `none`
  const std::uint32_t* texel = nullptr;       ///< per texture cell of a block: surface cell number, or `none`
  const std::uint32_t* position = nullptr;    ///< per surface cell: index of its texture cell in `texel`
  const std::uint32_t* block_cell = nullptr;  ///< per block: address of its closest-point cell
  const std::uint32_t* first_surface_cell = nullptr;  ///< per block, and behind the last; its others follow
  const Float4* seed = nullptr;                       ///< per surface cell: closest point minus centre; w unused
  const std::uint32_t* seed_triangle = nullptr;       ///< per surface cell: the triangle of its closest point
  const std::uint32_t* neighbour = nullptr;  ///< 6 per surface cell, -x +x -y +y -z +z; itself if there is none

  NACRE_HD int cells_per_block() const { return refine * refine * refine; }

  NACRE_HD Int3 outer(const Int3& cell) const { return {divide(cell.x), divide(cell.y), divide(cell.z)}; }

  /// Block of a closest-point cell, or `none`.
  NACRE_HD std::uint32_t block_of(const Int3& outer_cell) const {
    const std::uint32_t at = grid.address(outer_cell);
    return at == none ? none : block[at];
  }

  /// How many surface cells a block has.
  NACRE_HD int surface_cells_in(std::int64_t b) const { return int(first_surface_cell[b + 1] - first_surface_cell[b]); }

  /// Entry of `texel` of a texture cell whose block is known.
  NACRE_HD std::uint32_t entry_in(std::uint32_t b, const Int3& cell, const Int3& outer_cell) const {
    const Int3 in = cell - outer_cell * Int3(refine);
    return b * cells_per_block() + (in.z * refine + in.y) * refine + in.x;
  }

  /// Entry of `texel` of a texture cell, or `none`.
  NACRE_HD std::uint32_t entry(const Int3& cell) const {
    const Int3 outer_cell = outer(cell);
    const std::uint32_t b = block_of(outer_cell);
    return b == none ? none : entry_in(b, cell, outer_cell);
  }

  /// Surface cell at `cell`, or the one that contains its closest point, or `none`.
  NACRE_HD std::uint32_t surface_cell(const Int3& cell) const {
    const std::uint32_t at = entry(cell);
    return at == none ? none : surface_cell_at(at);
  }

  /// The same, from the cell's entry of `texel`.
  NACRE_HD std::uint32_t surface_cell_at(std::uint32_t at) const {
    const std::uint32_t value = texel[at];
    return value == none ? none : value & ~extended;
  }

  /// Coordinates of surface cell `s`.
  NACRE_HD Int3 cell(std::uint32_t s) const { return texel_cell(position[s]); }

  NACRE_HD Int3 texel_cell(std::uint32_t at) const {
    const std::uint32_t b = divide.cubes(at);
    return corner(b) + divide.cell_of_cube(int(at - b * cells_per_block()));
  }

  /// First cell of a block.
  NACRE_HD Int3 corner(std::uint32_t b) const { return grid.cell(block_cell[b]) * Int3(refine); }

  /// Closest point on the surface to the centre of surface cell `s`.
  NACRE_HD Vec3f seed_point(std::uint32_t s) const {
    return cell_centre(cell(s)) + Vec3f(seed[s].x, seed[s].y, seed[s].z);
  }
};

/// What `texel` stores for cells near each other, one or several at a time: remembers the blocks of the last ones.
template <class Wide>
class SurfaceCellCursors {
 public:
  using Int = typename Wide::Int;
  using Mask = typename Wide::Mask;

  NACRE_HD_INLINE explicit SurfaceCellCursors(const RefinedGridView& texture) : texture_(texture) {}

  /// With the bit `extended` where the surface does not pass through a cell; -1 where nothing is stored, and where
  /// `mask` is not set.
  NACRE_HD_INLINE Int texel(const Vec3<Int>& cell, Mask mask) {
    const RefinedGridView& t = texture_;
    const Vec3<Int> outer{t.divide(cell.x), t.divide(cell.y), t.divide(cell.z)};
    const Mask moved = mask & ((outer.x != outer_.x) | (outer.y != outer_.y) | (outer.z != outer_.z));
    if (any(moved)) {
      const Int at = t.grid.template addresses<Wide>(outer, moved);
      const Mask known = moved & (at != -1);
      block_ = select(moved, select(known, gather(t.block, at, known), Wide::all(-1)), block_);
      outer_ = {select(moved, outer.x, outer_.x), select(moved, outer.y, outer_.y), select(moved, outer.z, outer_.z)};
    }
    const Mask found = mask & (block_ != -1);
    const Vec3<Int> in{cell.x - outer.x * t.refine, cell.y - outer.y * t.refine, cell.z - outer.z * t.refine};
    const Int entry = block_ * t.cells_per_block() + (in.z * t.refine + in.y) * t.refine + in.x;
    return select(found, gather(t.texel, entry, found), Wide::all(-1));
  }

 private:
  const RefinedGridView& texture_;
  Vec3<Int> outer_{Wide::all(-1), Wide::all(-1), Wide::all(-1)};
  Int block_ = Wide::all(-1);
};

/// `surface_cell` for cells near each other.
class SurfaceCellCursor {
 public:
  NACRE_HD_INLINE explicit SurfaceCellCursor(const RefinedGridView& texture) : cursor_(texture) {}

  NACRE_HD_INLINE std::uint32_t find(const Int3& cell) {
    const std::uint32_t value = texel(cell);
    return value == none ? none : value & ~RefinedGridView::extended;
  }

  /// What `texel` stores for the cell: with the bit `extended` where the surface does not pass through it.
  NACRE_HD_INLINE std::uint32_t texel(const Int3& cell) { return std::uint32_t(cursor_.texel(cell, true)); }

 private:
  SurfaceCellCursors<Single> cursor_;
};

/// `values` (one per surface cell) at point `p`, linear among the texture cells around it, extended off the surface.
NACRE_HD inline float sample(const RefinedGridView& texture, const float* values, const Vec3f& p, float missing) {
  const Int3 first = floor_cell(p - Vec3f(0.5f));
  const Vec3f f = p - cell_centre(first);
  float sum = 0, weight = 0;
  SurfaceCellCursor cursor(texture);
  for (int k = 0; k < 8; ++k) {
    const int x = k & 1, y = k >> 1 & 1, z = k >> 2;
    const std::uint32_t s = cursor.find(first + Int3(x, y, z));
    if (s == none) continue;
    const float w = (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y) * (z ? f.z : 1 - f.z);
    sum += w * values[s];
    weight += w;
  }
  return weight > 0 ? sum / weight : missing;
}

}  // namespace nacre
