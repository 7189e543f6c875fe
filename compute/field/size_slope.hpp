// Nacre: sizes that grow no faster than a given slope.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "compute/field/lattice.hpp"

namespace nacre {
namespace detail {

/// One round of |grad h| <= delta: in each tile sweeps of Godunov's upwind solution from the smallest neighbours on
/// each axis, every second row at a time, with what the tiles beside it had in the round before (the fast iterative
/// method on blocks, Jeong & Whitaker 2008). Looks at tiles that have changed, or one beside them has: elsewhere `from`
/// and `to` are alike.
struct LimitSlope {
  TilesView tiles;
  float delta;
  const float* from;
  float* to;
  const std::uint32_t* had_changed;  ///< per stored tile
  std::uint32_t* changed;
  std::uint32_t* any;

  static constexpr float least_change = 1e-3f;
  static constexpr int most_sweeps = 2 * Lattice::tile;  ///< a round; then the tiles beside it are due
  static constexpr int n = Lattice::tile, wide = n + 2;  ///< cells of a tile, and with those beside it, along an axis

  struct Scratch {
    std::uint32_t beside[6];
    float h[wide * wide * wide];  ///< of the tile and the cells beside its faces, x fastest
  };
  static constexpr std::size_t scratch_bytes() { return sizeof(Scratch); }

  NACRE_HD void operator()(Team& team, std::int64_t s) const {
    Scratch& own = *reinterpret_cast<Scratch*>(team.scratch());
    const Int3 at = tiles.lattice.tile_at(tiles.tile[s]);
    team.each(6, [&](int k) {
      Int3 step{};
      step[k / 2] = k % 2 ? 1 : -1;
      own.beside[k] = tiles.beside(at, step);
    });
    if (!needed(own, s)) {
      if (team.first()) changed[s] = 0;
      return;
    }
    load(team, s, own);
    const Int3 held = min(tiles.lattice.cells - at * Int3(n), Int3(n));
    int limited = 0;
    for (int sweep = 0, now = 1; now > 0 && sweep < most_sweeps; ++sweep, limited += now) {
      now = 0;
      for (int colour = 0; colour < 2; ++colour)
        now += team.sum(n * n / 2, 0, [&](int row) {
          const int z = row / (n / 2), y = row % (n / 2) * 2 + (z + colour) % 2;
          return y < held.y && z < held.z ? limit_row(own.h + place(0, y, z), held.x) : 0;
        });
    }
    team.each(Lattice::tile_cells,
              [&](int k) { to[s * Lattice::tile_cells + k] = own.h[place(k % n, k / n % n, k / (n * n))]; });
    if (!team.first()) return;
    changed[s] = limited > 0;
    if (limited > 0) relaxed_store(any, 1);
  }

 private:
  NACRE_HD static int place(int x, int y, int z) { return ((z + 1) * wide + y + 1) * wide + x + 1; }

  NACRE_HD bool needed(const Scratch& own, std::int64_t s) const {
    if (had_changed[s]) return true;
    for (int k = 0; k < 6; ++k)
      if (own.beside[k] != none && had_changed[own.beside[k]]) return true;
    return false;
  }

  /// Beside the tile more than any size where none is stored: it has the largest of all sizes, or is not there.
  NACRE_HD void load(Team& team, std::int64_t s, Scratch& own) const {
    team.each(Lattice::tile_cells,
              [&](int k) { own.h[place(k % n, k / n % n, k / (n * n))] = from[s * Lattice::tile_cells + k]; });
    team.each(6 * n * n, [&](int i) {
      const int k = i / (n * n), axis = k / 2;
      Int3 cell{};
      cell[(axis + 1) % 3] = i % n, cell[(axis + 2) % 3] = i / n % n;
      cell[axis] = k % 2 ? 0 : n - 1;
      const std::uint32_t tile = own.beside[k];
      const float h = tile == none
                          ? 3e38f
                          : from[std::int64_t(tile) * Lattice::tile_cells + Lattice::place(cell.x, cell.y, cell.z)];
      cell[axis] = k % 2 ? n : -1;
      own.h[place(cell.x, cell.y, cell.z)] = h;
    });
  }

  /// The first `held` cells of a row. Returns how many became smaller.
  NACRE_HD int limit_row(float* row, int held) const {
    float limited[n];
#if !defined(__CUDACC__)
#pragma omp simd
#endif
    for (int x = 0; x < n; ++x) limited[x] = limit(row + x);
    int smaller = 0;
    for (int x = 0; x < held; ++x) {
      if (!(limited[x] < row[x] - least_change)) continue;
      row[x] = limited[x];
      ++smaller;
    }
    return smaller;
  }

  /// The smaller neighbour of a cell along an axis.
  struct Neighbour {
    float h, spacing, weight;  ///< weight: 1 / spacing^2

    NACRE_HD_INLINE static void sort(Neighbour& a, Neighbour& b) {
      const Neighbour low = a.h <= b.h ? a : b, high = a.h <= b.h ? b : a;
      a = low, b = high;
    }
  };

  NACRE_HD_INLINE Neighbour neighbour(const float* h, int axis, int stride) const {
    const float spacing = tiles.lattice.spacing[axis];
    return {min(h[-stride], h[stride]), spacing, 1 / (spacing * spacing)};
  }

  /// Solves sum over the axes of ((x - neighbour) / spacing)^2 = delta^2, for those axes whose neighbours x lies above.
  /// Where one is not there, the solution that would need it is not a number, and is not taken.
  NACRE_HD_INLINE float limit(const float* h) const {
    Neighbour a = neighbour(h, 0, 1), b = neighbour(h, 1, wide), c = neighbour(h, 2, wide * wide);
    Neighbour::sort(a, b), Neighbour::sort(b, c), Neighbour::sort(a, b);
    const float to_b = b.h - a.h, to_c = c.h - a.h;
    const float one = delta * a.spacing;
    const float w2 = a.weight + b.weight, b2 = b.weight * to_b;
    const float two = (b2 + std::sqrt(b2 * b2 - w2 * (b2 * to_b - delta * delta))) / w2;
    const float w3 = w2 + c.weight, b3 = b2 + c.weight * to_c;
    const float three = (b3 + std::sqrt(b3 * b3 - w3 * (b2 * to_b + c.weight * to_c * to_c - delta * delta))) / w3;
    return a.h + (one <= to_b ? one : two <= to_c ? two : three);
  }
};

/// Whether cells that are not stored would become smaller: a stored one beside them is smaller than all of them by more
/// than one step of the slope, in the worst case along all three axes.
struct SpillsOver {
  TilesView tiles;
  const float* h;
  float limit;

  NACRE_HD std::uint64_t operator()(std::int64_t i) const {
    if (!(h[i] < limit)) return 0;
    const Int3 c = tiles.cell(i);
    for (int k = 0; k < 6; ++k) {
      Int3 next = c;
      next[k / 2] += k % 2 ? 1 : -1;
      if (tiles.lattice.holds(c) && tiles.lattice.holds(next) && tiles.slot(next) < 0) return 1;
    }
    return 0;
  }
};

struct CopySize {
  const float* from;
  float* to;
  NACRE_HD void operator()(std::int64_t i) const { to[i] = from[i]; }
};

}  // namespace detail

/// Limits the slope of sizes, which are `far` in the cells that are not stored, to `delta`. False where that goes on
/// beyond the stored tiles.
template <class Backend>
bool limit_slope(Executor<Backend>& exec, const LatticeTiles& stored, float delta, float far, Array<float>& h) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const TilesView tiles = stored.view();
  Array<float> other = arena.temporary<float>(h.size());
  Array<std::uint32_t> changed[2] = {arena.temporary<std::uint32_t>(stored.count()),
                                     arena.temporary<std::uint32_t>(stored.count())};
  Array<std::uint32_t> any = arena.temporary<std::uint32_t>(1);
  changed[0].fill_bytes(1);
  exec.for_each(stored.slots(), detail::CopySize{h.data(), other.data()});
  float *from = h.data(), *to = other.data();
  const Int3& cells = tiles.lattice.cells;
  const int most_rounds = cells.x + cells.y + cells.z;
  for (int round = 0; round < most_rounds || from != h.data(); ++round) {
    any.fill_bytes(0);
    exec.for_each_team(stored.count(), detail::LimitSlope{tiles, delta, from, to, changed[round % 2].data(),
                                                          changed[1 - round % 2].data(), any.data()});
    std::swap(from, to);
    if (any.download()[0] == 0 && from == h.data()) break;
  }
  const Vec3f& s = tiles.lattice.spacing;
  const float limit = far - 0.57f * delta * std::min({s.x, s.y, s.z});
  return exec.reduce(stored.slots(), std::uint64_t(0), detail::SpillsOver{tiles, h.data(), limit}, Add{}) == 0;
}

}  // namespace nacre
