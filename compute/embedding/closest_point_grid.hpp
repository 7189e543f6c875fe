// Nacre: the two-level closest-point grid as kernels see it (thesis, sec. 5.1): look-up, interpolation, projection.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/embedding/triangle.hpp"
#include "compute/math/lanes.hpp"
#include "compute/math/morton.hpp"
#include "compute/math/packet.hpp"
#include "compute/math/vec.hpp"
#include "compute/math/weno4.hpp"

namespace nacre {

/// The triangles behind an embedding. Points are in cells of the closest-point grid.
struct MeshView {
  const Vec3d* points;
  const Triangle* triangles;
  const Vec3f* corner_normals;  ///< 3 per triangle

  NACRE_HD Corners corners(std::uint32_t t) const {
    const Triangle tri = triangles[t];
    return {points[tri.a], points[tri.b], points[tri.c]};
  }

  /// Unit normal at a point with these barycentric coordinates.
  NACRE_HD Vec3f normal(std::uint32_t t, const Vec3f& weights) const {
    const Vec3f n = unscaled_normal(t, weights);
    const float size = length(n);
    return size > 0 ? n * (1 / size) : Vec3f{};
  }

  /// The same, of another length.
  NACRE_HD Vec3f unscaled_normal(std::uint32_t t, const Vec3f& weights) const {
    const Vec3f* n = corner_normals + 3 * std::size_t(t);
    return n[0] * weights.x + n[1] * weights.y + n[2] * weights.z;
  }

  /// What vectors of the points become at a point with these barycentric coordinates: interpolated, and without their
  /// part along the normal.
  NACRE_HD Vec3f tangential(const Vec3f* vectors, std::uint32_t t, const Vec3f& weights) const {
    const Triangle corner = triangles[t];
    const Vec3f v = vectors[corner.a] * weights.x + vectors[corner.b] * weights.y + vectors[corner.c] * weights.z;
    const Vec3f n = unscaled_normal(t, weights);
    const float squared = dot(n, n);
    return squared > 0 ? v - n * (dot(n, v) / squared) : v;
  }
};

/// Division of a cell coordinate by a small number, by shifting if possible.
struct Divider {
  int divisor = 1;
  int shift = 0;  ///< -1: not a power of two
  float inverse = 1;

  Divider() = default;
  NACRE_HD explicit Divider(int d) : divisor(d), shift(-1), inverse(1.0f / float(d)) {
    for (int k = 0; k < 5; ++k)
      if (d == 1 << k) shift = k;
  }
  /// Exact for 0 <= i < 2^20; floors for negative ones. One number or a packet.
  template <class Int>
  NACRE_HD_INLINE Int operator()(const Int& i) const {
    return shift >= 0 ? i >> shift : floor_to_int((to_float(i) + 0.5f) * inverse);
  }
  /// By the cube of the divisor; exact for every number.
  NACRE_HD_INLINE std::uint32_t cubes(std::uint32_t i) const {
    return shift >= 0 ? i >> 3 * shift : i / std::uint32_t(divisor * divisor * divisor);
  }
  /// The cell of a cube of `divisor`^3 cells, x fastest.
  NACRE_HD_INLINE Int3 cell_of_cube(int i) const {
    const int row = (*this)(i), layer = (*this)(row);
    return {i - row * divisor, row - layer * divisor, layer};
  }
};

// Stencil, LinearCells and weno4_stencil work on any grid of bricks that has sub, divide, dims(), inside(),
// cells_per_brick(), brick() and, for weno4_stencil, offset.

/// A coarse grid of bricks near the surface, `sub`^3 cells each. Cell (i, j, k) has its centre at (i, j, k) + 0.5; all
/// lengths are in cells. Every cell of a brick stores a closest point; within `radius` of the surface it is exact.
struct ClosestPointGridView {
  Int3 bricks{};      ///< extent of the coarse grid
  int sub = 4;        ///< cells per brick and axis, 3..8
  Divider divide{4};  ///< by sub
  float radius = 0;
  const std::uint32_t* brick_index = nullptr;     ///< per coarse cell, x fastest: number of its brick, or `none`
  const std::uint64_t* brick_code = nullptr;      ///< per brick: Morton code of its coarse cell
  const Float4* offset = nullptr;                 ///< per cell: closest point minus centre, and its length
  const std::uint32_t* triangle = nullptr;        ///< per cell: the triangle of the closest point
  const std::uint32_t* touch_start = nullptr;     ///< per cell: where its list in `touch_triangle` begins
  const std::uint32_t* touch_triangle = nullptr;  ///< triangles that touch the cell, ascending

  NACRE_HD int cells_per_brick() const { return sub * sub * sub; }
  NACRE_HD Int3 dims() const { return bricks * Int3(sub); }
  NACRE_HD bool inside(const Int3& cell) const { return is_within(cell, dims()); }

  NACRE_HD std::uint32_t brick(int bx, int by, int bz) const {
    return brick_index[(std::int64_t(bz) * bricks.y + by) * bricks.x + bx];
  }

  /// Address of a cell in the arrays, or `none` outside of the bricks.
  NACRE_HD std::uint32_t address(const Int3& cell) const { return std::uint32_t(addresses<Single>(cell, true)); }

  /// Addresses of one cell or several, -1 outside of the bricks and where they are masked out.
  template <class Wide, class Int = typename Wide::Int, class Mask = typename Wide::Mask>
  NACRE_HD_INLINE Int addresses(const Vec3<Int>& cell, Mask mask) const {
    const Int3 size = dims();
    mask = mask & (cell.x >= 0) & (cell.y >= 0) & (cell.z >= 0) & (cell.x < size.x) & (cell.y < size.y) &
           (cell.z < size.z);
    const Vec3<Int> at{divide(cell.x), divide(cell.y), divide(cell.z)};
    const Int brick =
        select(mask, gather(brick_index, (at.z * bricks.y + at.y) * bricks.x + at.x, mask), Wide::all(-1));
    const Vec3<Int> in{cell.x - at.x * sub, cell.y - at.y * sub, cell.z - at.z * sub};
    return select(brick != -1, brick * cells_per_brick() + (in.z * sub + in.y) * sub + in.x, Wide::all(-1));
  }

  /// Coordinates of the cell at an address.
  NACRE_HD Int3 cell(std::uint32_t at) const {
    const std::uint32_t b = divide.cubes(at);
    return morton_cell(brick_code[b]) * Int3(sub) + divide.cell_of_cube(int(at - b * cells_per_brick()));
  }
};

NACRE_HD_INLINE Int3 floor_cell(const Vec3f& p) {
  return {int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
}

NACRE_HD_INLINE Vec3f cell_centre(const Int3& c) { return {c.x + 0.5f, c.y + 0.5f, c.z + 0.5f}; }

/// Addresses of the N^3 cells of a stencil: the stencil meets at most two bricks per axis (N <= sub + 1).
template <int N>
struct Stencil {
  Int3 first;                   ///< lowest cell
  int split[3];                 ///< how many of the N are in the lower brick
  int local[3];                 ///< position of the first one in its brick
  std::uint32_t base[2][2][2];  ///< [z][y][x]: address of a brick's cell 0

  /// False if a brick is missing.
  template <class Grid>
  NACRE_HD_INLINE bool find(const Grid& grid, const Int3& lowest) {
    first = lowest;
    const Int3 dims = grid.dims();
    if (first.x < 0 || first.y < 0 || first.z < 0 || first.x + N > dims.x || first.y + N > dims.y ||
        first.z + N > dims.z)
      return false;
    int brick[3] = {}, count[3] = {};
    for (int axis = 0; axis < 3; ++axis) {
      brick[axis] = grid.divide(first[axis]);
      local[axis] = first[axis] - brick[axis] * grid.sub;
      split[axis] = grid.sub - local[axis];
      count[axis] = split[axis] < N ? 2 : 1;
    }
    const int volume = grid.cells_per_brick();
    for (int z = 0; z < count[2]; ++z)
      for (int y = 0; y < count[1]; ++y)
        for (int x = 0; x < count[0]; ++x) {
          const std::uint32_t b = grid.brick(brick[0] + x, brick[1] + y, brick[2] + z);
          if (b == none) return false;
          base[z][y][x] = b * volume;
        }
    return true;
  }

  /// Address of node (a, b, c) = that of row (b, c) plus the entry of `x`.
  template <class Grid>
  NACRE_HD_INLINE std::uint32_t address(const Grid& grid, int a, int b, int c) const {
    const int sub = grid.sub;
    const int hx = a >= split[0], hy = b >= split[1], hz = c >= split[2];
    const int x = local[0] + a - hx * sub, y = local[1] + b - hy * sub, z = local[2] + c - hz * sub;
    return base[hz][hy][hx] + (z * sub + y) * sub + x;
  }
};

/// The eight cells around a point, for linear interpolation of anything that is stored per cell.
struct LinearCells {
  std::uint32_t at[8];  ///< addresses, x fastest
  Vec3f f;              ///< displacement of the point from the centre of the first cell, 0..1

  /// False if the surface is too far away for the eight to exist.
  template <class Grid>
  NACRE_HD_INLINE bool find(const Grid& grid, const Vec3f& p) {
    const Int3 first = floor_cell(p - Vec3f(0.5f));
    f = p - cell_centre(first);
    const Int3 brick{grid.divide(first.x), grid.divide(first.y), grid.divide(first.z)};
    const int sub = grid.sub;
    const Int3 local = first - brick * Int3(sub);
    if (local.x + 1 < sub && local.y + 1 < sub && local.z + 1 < sub) {  // all in one brick
      if (!grid.inside(first)) return false;
      const std::uint32_t b = grid.brick(brick.x, brick.y, brick.z);
      if (b == none) return false;
      const std::uint32_t corner = b * grid.cells_per_brick() + (local.z * sub + local.y) * sub + local.x;
      for (int k = 0; k < 8; ++k) at[k] = corner + ((k >> 2) * sub + (k >> 1 & 1)) * sub + (k & 1);
      return true;
    }
    Stencil<2> stencil;
    if (!stencil.find(grid, first)) return false;
    for (int k = 0; k < 8; ++k) at[k] = stencil.address(grid, k & 1, k >> 1 & 1, k >> 2);
    return true;
  }

  NACRE_HD_INLINE Lanes interpolate(const Float4* values) const {
    return interpolate([&](std::uint32_t k) { return load(values[k]); });
  }

  /// Of the values `value(address)`.
  template <class At>
  NACRE_HD_INLINE Lanes interpolate(const At& value) const {
    const Lanes a = value(at[0]), b = value(at[2]), c = value(at[4]), d = value(at[6]);
    const Lanes e = a + (value(at[1]) - a) * f.x, g = b + (value(at[3]) - b) * f.x;
    const Lanes h = c + (value(at[5]) - c) * f.x, i = d + (value(at[7]) - d) * f.x;
    const Lanes low = e + (g - e) * f.y, high = h + (i - h) * f.y;
    return low + (high - low) * f.z;
  }
};

#if defined(NACRE_PACKETS)
/// The same around several points at a time.
struct LinearCellsOfPacket {
  Packet::Int at[8];
  Vec3<Packet::Float> f;
  Packet::Mask found;  ///< where all eight exist

  LinearCellsOfPacket(const ClosestPointGridView& grid, const Vec3<Packet::Float>& p, Packet::Mask mask) : found(mask) {
    const Vec3<Packet::Float> half(Packet::all(0.5f));
    const Vec3<Packet::Int> first = cells_of(p - half);
    f = p - (corners_of(first) + half);
    for (int k = 0; k < 8; ++k) {
      at[k] = grid.addresses<Packet>({first.x + (k & 1), first.y + (k >> 1 & 1), first.z + (k >> 2)}, found);
      found = found & (at[k] != -1);
    }
  }

  Vec3<Packet::Float> interpolate(const Float4* values) const {
    Vec3<Packet::Float> result;
    for (int lane = 0; lane < Packet::lanes; ++lane) {
      if (!found[lane]) continue;
      LinearCells cells;
      for (int k = 0; k < 8; ++k) cells.at[k] = std::uint32_t(at[k][lane]);
      cells.f = {f.x[lane], f.y[lane], f.z[lane]};
      const Lanes value = cells.interpolate(values);
      result.x[lane] = value[0], result.y[lane] = value[1], result.z[lane] = value[2];
    }
    return result;
  }
};
#endif

/// `values` interpolated linearly at `p`. False if the surface is too far away for the eight cells to exist.
NACRE_HD_INLINE bool interpolate_linear(const ClosestPointGridView& grid, const Float4* values, const Vec3f& p,
                                        Lanes& result) {
  LinearCells cells;
  if (!cells.find(grid, p)) return false;
  result = cells.interpolate(values);
  return true;
}

#if defined(__CUDACC__)
/// The closest point of `p` relative to the centre of cell `first + 1`; the fourth lane is unused.
template <class Grid>
NACRE_HD_INLINE Lanes weno4_stencil(const Grid& grid, const Stencil<4>& stencil, const Vec3f& f) {
  Lanes row[4];
  for (int c = 0; c < 4; ++c) {
    Lanes column[4];
    for (int b = 0; b < 4; ++b) {
      Lanes node[4];
      for (int a = 0; a < 4; ++a)
        node[a] = load(grid.offset[stencil.address(grid, a, b, c)]) + lanes(float(a - 1), float(b - 1), float(c - 1));
      column[b] = weno4(node[0], node[1], node[2], node[3], f.x);
    }
    row[c] = weno4(column[0], column[1], column[2], column[3], f.y);
  }
  return weno4(row[0], row[1], row[2], row[3], f.z);
}
#else
template <class Grid>
NACRE_HD_INLINE Lanes weno4_stencil(const Grid& grid, const Stencil<4>& stencil, const Vec3f& f) {
  std::uint32_t column[4];  // where node a of row (0, 0) would be, without the address of its brick
  const int sub = grid.sub;
  for (int a = 0; a < 4; ++a) column[a] = stencil.local[0] + a - (a >= stencil.split[0] ? sub : 0);
  Row slab[4];
  for (int b = 0; b < 4; ++b) {
    const int hy = b >= stencil.split[1];
    const int y = stencil.local[1] + b - hy * sub;
    Row rows[4];
    for (int c = 0; c < 4; ++c) {
      const int hz = c >= stencil.split[2];
      const std::uint32_t line = ((stencil.local[2] + c - hz * sub) * sub + y) * sub;
      const auto* lower = grid.offset + stencil.base[hz][hy][0] + line;
      const auto* upper = grid.offset + stencil.base[hz][hy][1] + line;
      const Row nodes =
          row(lower[column[0]], (1 < stencil.split[0] ? lower : upper)[column[1]],
              (2 < stencil.split[0] ? lower : upper)[column[2]], (3 < stencil.split[0] ? lower : upper)[column[3]]);
      const float v = float(b - 1), w = float(c - 1);
      rows[c] = nodes + Row{-1, v, w, 0, 0, v, w, 0, 1, v, w, 0, 2, v, w, 0};
    }
    slab[b] = weno4(rows[0], rows[1], rows[2], rows[3], f.z);
  }
  const Row line = weno4(slab[0], slab[1], slab[2], slab[3], f.y);
  return weno4(node<0>(line), node<1>(line), node<2>(line), node<3>(line), f.x);
}
#endif

/// Point of the surface that belongs to `p` (thesis, sec. 5.1.2): WENO4 of the closest points around it; at the edge of
/// the band the closest point of the nearest cell. False if `p` is outside of the band.
NACRE_HD inline bool project(const ClosestPointGridView& grid, const Vec3f& p, Vec3f& on_surface) {
  const Int3 lower = floor_cell(p - Vec3f(0.5f));
  Stencil<4> stencil;
  if (stencil.find(grid, lower - Int3(1))) {
    const Vec3f base = cell_centre(lower);
    on_surface = base + xyz(weno4_stencil(grid, stencil, p - base));
    return true;
  }
  const Int3 cell = floor_cell(p);
  const std::uint32_t at = grid.address(cell);
  if (at == none) return false;
  const Float4 offset = grid.offset[at];
  on_surface = cell_centre(cell) + Vec3f(offset.x, offset.y, offset.z);
  return true;
}

}  // namespace nacre
