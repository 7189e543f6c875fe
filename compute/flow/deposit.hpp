// Nacre: accumulation of values along pathlines in exact arithmetic.
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/refined_grid.hpp"

namespace nacre {

/// A sum of values and the number of hits in one 64-bit word, so that both are added by one atomic operation and no
/// order of additions changes the result: hits in the upper 24 bits, 16-bit values summed in the lower 40. Holds 16
/// million hits per cell.
struct Deposit {
  static constexpr int hit_shift = 40;

  NACRE_HD static constexpr std::uint64_t pack(std::uint32_t value16) {
    return std::uint64_t(1) << hit_shift | std::uint64_t(value16);
  }
  NACRE_HD static std::uint32_t quantise(float value) { return std::uint32_t(value * 65535.0f + 0.5f); }
  NACRE_HD static std::uint64_t hits(std::uint64_t sum) { return sum >> hit_shift; }
  NACRE_HD static std::uint64_t value(std::uint64_t sum) { return sum & ((std::uint64_t(1) << hit_shift) - 1); }
};

/// Axis along which a vector runs most; 0 for no vector.
NACRE_HD_INLINE int main_axis(float x, float y, float z) {
  x = std::fabs(x);
  y = std::fabs(y);
  z = std::fabs(z);
  return z > x && z > y ? 2 : y > x ? 1 : 0;
}

/// Draws the line from `a` to `b` (texture cells), without the cell of `a` (Alg. 5.4 as decided: p advances by d / N, N
/// the largest of the differences between the cells, which may be 0). Returns the number of cells hit.
/// The line is antialiased afterwards, once for all lines: the low-pass filter across it is linear, so it may as well be
/// applied to the sums (see `Antialias`).
NACRE_HD_INLINE int deposit_line(const RefinedGridView& texture, std::uint64_t* sums, const Vec3f& a, const Vec3f& b,
                                 std::uint32_t value16) {
  const Int3 cells = floor_cell(b) - floor_cell(a);
  const Vec3f d = b - a;
  const int x = cells.x < 0 ? -cells.x : cells.x, y = cells.y < 0 ? -cells.y : cells.y;
  const int z = cells.z < 0 ? -cells.z : cells.z, xy = x > y ? x : y, n = xy > z ? xy : z;
  const float step = 1.0f / float(n > 0 ? n : 1);
  int hits = 0;
  SurfaceCellCursor cursor(texture);
  for (int i = 1; i <= n; ++i) {
    const std::uint32_t cell = cursor.find(floor_cell(a + d * (float(i) * step)));
    if (cell == none) continue;
    atomic_add(sums + cell, Deposit::pack(value16));
    ++hits;
  }
  return hits;
}

/// The axis of the flow in each surface cell: what a pathline there runs along.
struct PathAxis {
  RefinedGridView texture;
  const Float4* displacement;  ///< per closest-point cell
  std::uint8_t* axis;
  NACRE_HD void operator()(std::int64_t s) const {
    const Float4 v = displacement[texture.block_cell[texture.place[s] / texture.cells_per_block()]];
    axis[s] = std::uint8_t(main_axis(v.x, v.y, v.z));
  }
};

/// Normalised frame of antialiased lines: a hit counts half for its cell and an eighth for each of the four neighbours
/// in the plane across the line's main axis; a neighbour that projects back counts for the cell itself. The hit count
/// has the same weights, so the mean is exact.
struct Antialias {
  RefinedGridView texture;
  const std::uint64_t* sums;
  const std::uint8_t* axis;
  const float* otherwise;  ///< the value of a cell that nothing reached: nothing goes black
  float share;             ///< of the mean in the result; the rest is `otherwise`
  float* value;            ///< 0..1; may be `otherwise` itself

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t* neighbour = texture.neighbour + 6 * i;
    const std::uint64_t own = sums[i];
    std::uint64_t values = 4 * Deposit::value(own), weights = 4 * Deposit::hits(own);
    for (int k = 0; k < 6; ++k) {
      const std::uint32_t n = neighbour[k];
      if (axis[n] == k / 2) continue;
      values += Deposit::value(sums[n]);
      weights += Deposit::hits(sums[n]);
    }
    const float before = otherwise[i];
    const float mean = weights ? float(double(values) / (65535.0 * double(weights))) : before;
    value[i] = before + (mean - before) * share;
  }
};

}  // namespace nacre
