// Nacre: closest points of every interface and junction curve, in one two-level grid (thesis, sec. 4.1.1, 4.2).
#pragma once

#include "compute/embedding/closest_point_grid.hpp"
#include "compute/field/interface.hpp"
#include "compute/math/bits.hpp"

namespace nacre {

/// A closest point as a cell stores it, in 16 bytes, so that all of the 64 cells that a projection reads fit into few
/// cache lines. The rounding of a position, 2^-13 of a cell, is far below the error of WENO on such cells.
struct alignas(16) EmbeddedCell {
  std::int16_t offset[3];     ///< closest point minus the cell's centre, `offset_unit` cells
  std::int16_t margin;        ///< `margin_unit` voxels
  std::int16_t direction[3];  ///< `direction_unit`
  std::uint16_t size;         ///< h in units of the grid's `size_unit`

  static constexpr float offset_unit = 0x1p-12f, margin_unit = offset_unit, direction_unit = 0x1p-14f;

  EmbeddedCell() = default;
  /// `offset`: w is the margin; `direction`: w is h. Values beyond the range are clamped: 8 cells, 8 voxels.
  NACRE_HD EmbeddedCell(const Float4& o, const Float4& d, float size_unit)
      : offset{rounded(o.x / offset_unit), rounded(o.y / offset_unit), rounded(o.z / offset_unit)},
        margin(rounded(o.w / margin_unit)),
        direction{rounded(d.x / direction_unit), rounded(d.y / direction_unit), rounded(d.z / direction_unit)},
        size(std::uint16_t(min(d.w / size_unit + 0.5f, 65535.0f))) {}

 private:
  NACRE_HD static std::int16_t rounded(float x) {
    return std::int16_t(min(max(std::floor(x + 0.5f), -32767.0f), 32767.0f));
  }
};

#if defined(__CUDACC__)
/// The offset and, in the fourth lane, the margin.
NACRE_HD_INLINE Lanes load(const EmbeddedCell& c) {
  const short4 o = *reinterpret_cast<const short4*>(c.offset);
  return lanes(float(o.x), float(o.y), float(o.z), float(o.w)) * EmbeddedCell::offset_unit;
}
/// The direction and, in the fourth lane, h in units of the grid.
NACRE_HD_INLINE Lanes load_direction(const EmbeddedCell& c) {
  const short4 d = *reinterpret_cast<const short4*>(c.direction);
  const float unit = EmbeddedCell::direction_unit;
  return lanes(float(d.x) * unit, float(d.y) * unit, float(d.z) * unit, float(std::uint16_t(d.w)));
}
#else
typedef std::int16_t Shorts __attribute__((vector_size(8), may_alias));
NACRE_HD_INLINE Shorts shorts(const std::int16_t& first) { return *reinterpret_cast<const Shorts*>(&first); }

NACRE_HD_INLINE Lanes load(const EmbeddedCell& c) {
  return __builtin_convertvector(shorts(c.offset[0]), Lanes) * EmbeddedCell::offset_unit;
}
NACRE_HD_INLINE Lanes load_direction(const EmbeddedCell& c) {
  const float unit = EmbeddedCell::direction_unit;
  Lanes d = __builtin_convertvector(shorts(c.direction[0]), Lanes) * Lanes{unit, unit, unit, 1};
  d[3] = float(c.size);
  return d;
}
/// The offsets of four cells side by side.
NACRE_HD_INLINE Row row(const EmbeddedCell& a, const EmbeddedCell& b, const EmbeddedCell& c, const EmbeddedCell& d) {
  const auto low = __builtin_shufflevector(shorts(a.offset[0]), shorts(b.offset[0]), 0, 1, 2, 3, 4, 5, 6, 7);
  const auto high = __builtin_shufflevector(shorts(c.offset[0]), shorts(d.offset[0]), 0, 1, 2, 3, 4, 5, 6, 7);
  const auto all = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return __builtin_convertvector(all, Row) * EmbeddedCell::offset_unit;
}
#endif

/// Of 64 coarse cells, x fastest, those that have bricks, and which of all that have some the first of them is.
struct CoarseWord {
  std::uint64_t mask = 0;
  std::uint32_t first = 0;
};

/// The bricks of a coarse cell: `first` to before `last`.
struct BrickRange {
  std::uint32_t first = 0, last = 0;
};

/// A coarse grid over the volume whose cells list bricks of 4^3 cells, one per interface nearby. Lengths are in cells,
/// `cells_per_voxel` to a voxel; cell (i, j, k) has its centre at (i, j, k) + 0.5.
struct InterfaceGridView {
  static constexpr int sub = 4;
  Int3 coarse{};  ///< extent of the coarse grid
  float cells_per_voxel = 2;
  const CoarseWord* word = nullptr;                ///< per 64 coarse cells, x fastest
  const std::uint32_t* brick_start = nullptr;      ///< per coarse cell that has bricks, and one more
  const std::uint32_t* brick_interface = nullptr;  ///< ascending within a coarse cell
  /// Closest points. The margin is by how much the interface's materials lead over all others there; negative beyond
  /// the rim of the interface.
  const EmbeddedCell* cell = nullptr;
  float size_unit = 1;      ///< of the cells' h, voxels
  bool seeds_only = false;  ///< only cells next to the interface have closest points: too few for stencils

  NACRE_HD Int3 dims() const { return coarse * Int3(sub); }
  NACRE_HD std::int64_t coarse_number(const Int3& c) const {
    return (std::int64_t(c.z) * coarse.y + c.y) * coarse.x + c.x;
  }
  NACRE_HD_INLINE BrickRange bricks(const Int3& c) const {
    const std::int64_t n = coarse_number(c);
    const CoarseWord w = word[n >> 6];
    const std::uint64_t bit = std::uint64_t(1) << (n & 63);
    if (!(w.mask & bit)) return {};
    const std::uint32_t* start = brick_start + w.first + count_bits(w.mask & (bit - 1));
    return {start[0], start[1]};
  }
  /// Direction and h (voxels) of cell `i`.
  NACRE_HD Float4 direction(std::int64_t i) const {
    Float4 d = store(load_direction(cell[i]));
    d.w *= size_unit;
    return d;
  }
};

/// The bricks of one interface, in the form that Stencil and LinearCells require.
struct InterfaceBricks {
  const InterfaceGridView& grid;
  std::uint32_t interface;
  static constexpr int sub = InterfaceGridView::sub;
  const EmbeddedCell* offset = grid.cell;

  NACRE_HD static int divide(int i) { return i >> 2; }
  NACRE_HD static int cells_per_brick() { return sub * sub * sub; }
  NACRE_HD Int3 dims() const { return grid.dims(); }
  NACRE_HD bool inside(const Int3& cell) const { return is_within(cell, dims()); }
  NACRE_HD std::uint32_t brick(int bx, int by, int bz) const {
    const BrickRange range = grid.bricks({bx, by, bz});
    for (std::uint32_t k = range.first; k < range.last; ++k)
      if (grid.brick_interface[k] == interface) return k;
    return none;
  }
};

/// A particle's position on its interface.
struct EmbeddedPoint {
  Vec3f p;          ///< voxels
  Vec3f direction;  ///< unit normal or tangent
  float h;          ///< sizing field, voxels
  float margin;     ///< voxels; negative beyond the rim
};

/// Projects `p` (voxels) onto the interface by WENO4 of the closest points around it (thesis, sec. 4.2.1); direction
/// and size are interpolated linearly at the result. False if the interface is too far away.
NACRE_HD inline bool project(const InterfaceGridView& grid, std::uint32_t interface, const Vec3f& p,
                             EmbeddedPoint& on) {
  const InterfaceBricks bricks{grid, interface};
  const Vec3f cell = p * grid.cells_per_voxel;
  const Int3 lower = floor_cell(cell - Vec3f(0.5f));
  Stencil<4> stencil;
  if (!stencil.find(bricks, lower - Int3(1))) return false;
  const Vec3f base = cell_centre(lower);
  const Float4 offset = store(weno4_stencil(bricks, stencil, cell - base));
  const Vec3f surface = base + Vec3f(offset.x, offset.y, offset.z);
  LinearCells around;
  if (!around.find(bricks, surface)) return false;
  const Float4 d = store(around.interpolate([&](std::uint32_t at) { return load_direction(grid.cell[at]); }));
  on.margin = store(around.interpolate([&](std::uint32_t at) { return load(grid.cell[at]); })).w;
  on.p = surface / grid.cells_per_voxel;
  on.direction = normalized(Vec3f(d.x, d.y, d.z));
  on.h = d.w * grid.size_unit;
  return is_finite(on.p) && dot(on.direction, on.direction) > 0.5f;
}

}  // namespace nacre
