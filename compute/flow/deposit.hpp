// Nacre: accumulation of values along pathlines in exact arithmetic.
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/flow/surface_cells.hpp"

namespace nacre {

/// Values and how much each weighs, summed in one 64-bit word, so that both are added by one atomic operation and no
/// order of additions changes the result: the weight in the upper 24 bits, weighted 16-bit values in the lower 40.
struct Deposit {
  static constexpr int weight_shift = 40;
  static constexpr std::uint32_t new_particle = 16;    ///< its weight; it shrinks as the particle ages
  static constexpr std::uint64_t most_particles = 64;  ///< that a cell hands over, in new ones: words cannot overflow

  NACRE_HD static constexpr std::uint64_t pack(std::uint32_t value16, std::uint32_t weight = 1) {
    return std::uint64_t(weight) << weight_shift | std::uint64_t(value16) * weight;
  }
  NACRE_HD static std::uint32_t quantise(float value) { return std::uint32_t(value * 65535.0f + 0.5f); }
  NACRE_HD static std::uint64_t weight(std::uint64_t sum) { return sum >> weight_shift; }
  NACRE_HD static std::uint64_t value(std::uint64_t sum) { return sum & ((std::uint64_t(1) << weight_shift) - 1); }

  /// The particles that begin a step in a cell: those that arrived there and live on, and a new one.
  NACRE_HD static std::uint64_t beginning(std::uint64_t arrived, float carried, int ttl) {
    return survivors(arrived, ttl) + pack(quantise(carried), new_particle);
  }

  /// What is left a step later of particles that live `ttl` steps in the mean: the same mean value, less weight.
  NACRE_HD static std::uint64_t survivors(std::uint64_t sum, int ttl) {
    const std::uint64_t before = weight(sum);
    if (before == 0) return 0;
    const std::uint64_t mean = (value(sum) + before / 2) / before, most = most_particles * new_particle;
    const std::uint64_t after = before * std::uint64_t(ttl - 1) / std::uint64_t(ttl);
    return pack(std::uint32_t(mean), std::uint32_t(after < most ? after : most));
  }
};

/// Number of cells that the line of displacement `cells` enters: the largest of the differences.
NACRE_HD_INLINE int cells_crossed(const Int3& cells) {
  const int x = cells.x < 0 ? -cells.x : cells.x, y = cells.y < 0 ? -cells.y : cells.y;
  const int z = cells.z < 0 ? -cells.z : cells.z, xy = x > y ? x : y;
  return xy > z ? xy : z;
}

/// Adds `word` along the line from `a` to `b` (texture cells), without the cell of `a` (Alg. 5.4 as decided: p advances
/// by d / N, N the number of cells crossed, which may be 0).
NACRE_HD_INLINE void deposit_line(const RefinedGridView& texture, std::uint64_t* sums, const Vec3f& a, const Vec3f& b,
                                  std::uint64_t word) {
  const Vec3f d = b - a;
  const int n = cells_crossed(floor_cell(b) - floor_cell(a));
  const float step = 1.0f / float(n > 0 ? n : 1);
  SurfaceCellCursor cursor(texture);
  for (int i = 1; i <= n; ++i) {
    const std::uint32_t cell = cursor.find(floor_cell(a + d * (float(i) * step)));
    if (cell != none) atomic_add(sums + cell, word);
  }
}

/// The new texture: in each cell the mean of the particles that arrived there; where none did, of those whose paths
/// crossed it; where none did either, of those that crossed a cell beside it. Lines are not antialiased (Alg. 5.4 does
/// so): streaks are convolved along the flow afterwards, which hides their steps, and what particles carry stays as
/// sharp as a cell.
template <class Surface>
struct Normalise {
  Surface surface;
  const std::uint64_t *arrived, *crossed;
  const float* otherwise;  ///< in a cell that nothing reached: nothing goes black
  float* value;            ///< 0..1

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    std::uint64_t word = arrived[s];
    if (word == 0) word = crossed[s];
    if (word == 0) word = beside(position);
    value[s] = word ? float(double(Deposit::value(word)) / (65535.0 * double(Deposit::weight(word)))) : otherwise[s];
  }

  NACRE_HD std::uint64_t beside(const Int3& position) const {
    typename Surface::Cursor cursor(surface);
    for (int k = 0; k < 6; ++k) {
      Int3 next = position;
      next[k / 2] += k & 1 ? 1 : -1;
      const CellIndex at = cursor.find(next).cell;
      if (at != no_cell && crossed[at] != 0) return crossed[at];
    }
    return 0;
  }
};

}  // namespace nacre
