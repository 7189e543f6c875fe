// Nacre: a narrow band of cells around a surface, whatever structure stores them: the common interface of both octrees
// (thesis, ch. 6).
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

// A view of a band has these members (BrickOctreeView and the view of the thesis's octree have them):
//
//   cells, surface_cells             how many cells are stored, and how many of them the surface passes through
//   point[c]                         CellPoint of cell c; `quantum` unpacks it
//   items()                          groups of cells that one team works on
//   each_cell(team, item, body)      body(cell, Int3 position, cursor&) for the group's cells
//   each_surface_cell(team, item, b) body(surface_cell, cell, Int3 position, cursor&) for those that the surface passes
//   Cursor                           finds cells near each other fast:
//     find(Int3)                       number of the cell, or `no_cell`
//     find_surface(Int3)               number of the surface cell, or `no_cell`
//     eight(Int3 first, at)            the 2^3 cells from `first`, x fastest; a bit for each that is stored
//     eight_surface(Int3 first, at)    the same among surface cells
//     each_surface_of_27(Int3 first, visit)  visit(k, number) for the surface cells of the 3^3 from `first`, x fastest
//
// Cell (i, j, k) has its centre at (i, j, k) + 1/2; all lengths are in cells. Numbers of cells are 64 bits wide.

using CellIndex = std::uint64_t;
inline constexpr CellIndex no_cell = ~CellIndex(0);

/// A point near a cell: far from the origin a single float could not represent the position within the cell.
struct BandPoint {
  Int3 base{};    ///< a cell
  Vec3f local{};  ///< from the lower corner of `base`

  NACRE_HD_INLINE BandPoint operator+(const Vec3f& displacement) const { return {base, local + displacement}; }
  NACRE_HD_INLINE Int3 cell() const {
    return base + Int3(int(std::floor(local.x)), int(std::floor(local.y)), int(std::floor(local.z)));
  }
};

NACRE_HD_INLINE BandPoint band_point(const Vec3d& p) {
  const Int3 base{int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
  return {base, Vec3f(p - Vec3d(base))};
}

/// What a cell stores: 12 bytes. The closest point relative to the cell's centre in 3 x 21 bits, which at a radius of 5
/// is exact to 2.4e-6 cells per axis, and the triangle on which it lies.
struct CellPoint {
  static constexpr int bits = 21;

  std::uint32_t low, high, triangle;

  /// Edge of the lattice to which offsets up to `radius` are rounded.
  NACRE_HD static float quantum(double radius) { return float(radius * 1.0001 / ((1 << (bits - 1)) - 1)); }

  /// One axis of an offset in steps of the lattice.
  NACRE_HD_INLINE static std::int32_t rounded(double offset, float quantum) {
    return std::int32_t(std::floor(offset / quantum + 0.5));
  }

  NACRE_HD_INLINE static CellPoint pack(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t triangle) {
    constexpr std::uint64_t mask = (1u << bits) - 1;
    const std::uint64_t all = (std::uint64_t(z) & mask) << 2 * bits | (std::uint64_t(y) & mask) << bits | (x & mask);
    return {std::uint32_t(all), std::uint32_t(all >> 32), triangle};
  }

  NACRE_HD static CellPoint pack(const Vec3d& offset, float quantum, std::uint32_t triangle) {
    return pack(rounded(offset.x, quantum), rounded(offset.y, quantum), rounded(offset.z, quantum), triangle);
  }

  /// Closest point minus the cell's centre.
  NACRE_HD_INLINE Vec3f offset(float quantum) const {
    const std::uint64_t all = std::uint64_t(high) << 32 | low;
    constexpr int up = 32 - bits;
    const std::int32_t x = std::int32_t(std::uint32_t(all) << up) >> up;
    const std::int32_t y = std::int32_t(std::uint32_t(all >> bits) << up) >> up;
    const std::int32_t z = std::int32_t(std::uint32_t(all >> 2 * bits) << up) >> up;
    return {float(x) * quantum, float(y) * quantum, float(z) * quantum};
  }
};

/// Closest point of cell `position`, whose record is `point`.
NACRE_HD_INLINE BandPoint closest_point_of(const Int3& position, const CellPoint& point, float quantum) {
  return {position, Vec3f(0.5f) + point.offset(quantum)};
}

/// Linear interpolation among the 2^3 cells around a point.
struct LinearWeights {
  Int3 first;  ///< the lowest cell
  Vec3f f;     ///< position from its centre, 0..1

  NACRE_HD_INLINE explicit LinearWeights(const BandPoint& p) {
    const Vec3f q = p.local - Vec3f(0.5f);
    const Vec3f whole{std::floor(q.x), std::floor(q.y), std::floor(q.z)};
    first = p.base + Int3(int(whole.x), int(whole.y), int(whole.z));
    f = q - whole;
  }

  NACRE_HD_INLINE float operator[](int k) const {
    return (k & 1 ? f.x : 1 - f.x) * (k & 2 ? f.y : 1 - f.y) * (k & 4 ? f.z : 1 - f.z);
  }
};

/// Quadratic B-spline among the 3^3 cells around a point: it smooths equally wherever the point lies between them.
struct SplineWeights {
  Int3 first;  ///< the lowest cell
  float w[3][3];

  NACRE_HD_INLINE explicit SplineWeights(const BandPoint& p) {
    const Vec3f whole{std::floor(p.local.x), std::floor(p.local.y), std::floor(p.local.z)};
    first = p.base + Int3(int(whole.x), int(whole.y), int(whole.z)) - Int3(1);
    for (int axis = 0; axis < 3; ++axis) {
      const float f = p.local[axis] - whole[axis], g = 1 - f;
      w[axis][0] = 0.5f * g * g;
      w[axis][1] = 0.5f + f * g;
      w[axis][2] = 0.5f * f * f;
    }
  }
};

/// Runs `kernel(cell, position, cursor)` on every cell of the band, or `kernel(surface_cell, cell, position, cursor)`
/// on those that the surface passes through.
template <class View, class Kernel>
struct OnCells {
  View view;
  Kernel kernel;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, std::int64_t item) const { view.each_cell(team, item, kernel); }
};

template <class View, class Kernel>
struct OnSurfaceCells {
  View view;
  Kernel kernel;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, std::int64_t item) const { view.each_surface_cell(team, item, kernel); }
};

template <class Backend, class View, class Kernel>
void for_each_cell(Executor<Backend>& exec, const View& view, const Kernel& kernel) {
  exec.for_each_team(view.items(), OnCells<View, Kernel>{view, kernel});
}

template <class Backend, class View, class Kernel>
void for_each_surface_cell(Executor<Backend>& exec, const View& view, const Kernel& kernel) {
  exec.for_each_team(view.items(), OnSurfaceCells<View, Kernel>{view, kernel});
}

}  // namespace nacre
