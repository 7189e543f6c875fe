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

/// Draws the line from `a` to `b` (texture cells), without the cell of `a` (Alg. 5.4 as decided: p advances by d / N, N
/// the largest of the differences between the cells, which may be 0). Returns the number of cells hit.
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

/// Normalised frame: the mean of what was deposited in each cell, or, where nothing was, in the six cells around it.
/// Lines are not antialiased (Alg. 5.4 does so): streaks are convolved along the flow afterwards, which hides their
/// steps, and what particles carry stays as sharp as a cell.
struct Normalise {
  RefinedGridView texture;
  const std::uint64_t* sums;
  const float* otherwise;  ///< the value of a cell that nothing reached: nothing goes black
  float share;             ///< of the mean in the result; the rest is `otherwise`
  float* value;            ///< 0..1; may be `otherwise` itself

  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t values = Deposit::value(sums[i]), hits = Deposit::hits(sums[i]);
    if (hits == 0) {
      for (int k = 0; k < 6; ++k) {
        const std::uint64_t beside = sums[texture.neighbour[6 * i + k]];
        values += Deposit::value(beside);
        hits += Deposit::hits(beside);
      }
    }
    const float before = otherwise[i];
    const float mean = hits ? float(double(values) / (65535.0 * double(hits))) : before;
    value[i] = before + (mean - before) * share;
  }
};

}  // namespace nacre
