// Nacre: bins of particles: cubes with an edge of a few h, in compute blocks of 3^3 (sec. 3.1.4, 3.2.1).
#pragma once

#include <array>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/particles/particle_set.hpp"

namespace nacre {

/// Where the bins are. Bins are numbered block by block, and within a block by colour: bins of one colour are three
/// apart along some axis.
struct BinGrid {
  Vec3f low;
  float edge = 1, inverse_edge = 1;
  Int3 blocks{1, 1, 1};  ///< of 3^3 bins

  NACRE_HD std::int64_t bins() const { return std::int64_t(blocks.x) * blocks.y * blocks.z * 27; }

  /// Beyond the grid: the nearest bin, so that neighbours stay neighbours.
  NACRE_HD Int3 bin(const Vec3f& p) const {
    return {along(p.x - low.x, blocks.x), along(p.y - low.y, blocks.y), along(p.z - low.z, blocks.z)};
  }
  NACRE_HD std::uint32_t number(const Int3& b) const {
    const std::uint32_t block = (std::uint32_t(b.z / 3) * blocks.y + b.y / 3) * blocks.x + b.x / 3;
    return block * 27 + std::uint32_t(b.x % 3 + 3 * (b.y % 3) + 9 * (b.z % 3));
  }
  NACRE_HD static int colour(std::uint32_t number) { return int(number % 27); }
  NACRE_HD Int3 bin_of(std::uint32_t number) const {
    const int c = colour(number), block = int(number / 27);
    return {block % blocks.x * 3 + c % 3, block / blocks.x % blocks.y * 3 + c / 3 % 3,
            block / blocks.x / blocks.y * 3 + c / 9};
  }
  NACRE_HD bool has(const Int3& b) const {
    return b.x >= 0 && b.y >= 0 && b.z >= 0 && b.x < 3 * blocks.x && b.y < 3 * blocks.y && b.z < 3 * blocks.z;
  }

 private:
  NACRE_HD int along(float distance, int n) const {
    const float at = distance * inverse_edge;
    return at > 0 ? (at < float(3 * n) ? int(at) : 3 * n - 1) : 0;  // NaN: 0
  }
};

/// Shortest edge for particles of size up to `largest` that move by up to `step` of it in their turn. Neighbours reach
/// support * min(h_i, h_j) from a trial position, and a neighbour may have left its bin by a step, too, earlier in the
/// same iteration: (sqrt 3 + 2 step) h. With steps of up to h/2 that is the (1 + sqrt 3) h that holds then; with
/// the thesis's own step of h it is (2 + sqrt 3) h.
inline float bin_edge(float largest, float step) { return (support + 2 * step) * largest; }

/// Bins between `low` and `high`; the edge grows until there are at most `most` of them, which keeps everything right.
inline BinGrid make_bin_grid(const Vec3f& low, const Vec3f& high, float edge, std::int64_t most) {
  BinGrid grid;
  grid.low = low;
  if (!(edge > 0)) edge = 1;
  for (int k = 0; k < 400; ++k, edge *= 1.25f) {
    double total = 27;
    for (int axis = 0; axis < 3; ++axis) {
      const double n = std::floor(double(high[axis] - low[axis]) / (3.0 * edge)) + 1;
      total *= n;
      if (total <= double(most)) grid.blocks[axis] = int(n);
    }
    if (total <= double(most)) break;
  }
  grid.edge = edge;
  grid.inverse_edge = 1 / edge;
  return grid;
}

/// The particles of each bin, as device arrays in temporary memory of the caller's scope.
struct Bins {
  BinGrid grid;
  float largest = 0;                 ///< h of all particles
  Array<std::uint32_t> order;        ///< particles, by bin and then by number
  Array<std::uint32_t> first, last;  ///< per bin: its part of `order`
  Array<std::uint32_t> occupied;     ///< numbers of the bins that hold moving particles, colour by colour, ascending
  std::array<std::int64_t, 28> colour{};  ///< where each colour begins in `occupied`, and the end
};

namespace detail {

struct Extent {
  Vec3f low, high;
  float largest;
};

struct ExtentOf {
  const Float4* position;
  NACRE_HD Extent operator()(std::int64_t i) const {
    const Vec3f p(position[i].x, position[i].y, position[i].z);
    return {p, p, position[i].w};
  }
};

struct MergeExtents {
  NACRE_HD Extent operator()(const Extent& a, const Extent& b) const {
    return {min(a.low, b.low), max(a.high, b.high), a.largest > b.largest ? a.largest : b.largest};
  }
};

struct BinKeys {
  BinGrid grid;
  const Float4* position;
  std::uint64_t* keys;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t bin = grid.number(grid.bin({position[i].x, position[i].y, position[i].z}));
    keys[i] = std::uint64_t(bin) << 32 | std::uint64_t(i);
  }
};

/// Reads sorted keys into `order` and the bins' ends; flags those at the end of a bin that holds moving particles (they
/// come last in a bin, having the higher numbers).
struct FindBins {
  const std::uint64_t* keys;
  std::int64_t count, fixed;
  std::uint32_t *order, *first, *last, *flag;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t bin = std::uint32_t(keys[i] >> 32), particle = std::uint32_t(keys[i]);
    order[i] = particle;
    if (i == 0 || std::uint32_t(keys[i - 1] >> 32) != bin) first[bin] = std::uint32_t(i);
    const bool end = i + 1 == count || std::uint32_t(keys[i + 1] >> 32) != bin;
    if (end) last[bin] = std::uint32_t(i + 1);
    flag[i] = end && particle >= fixed ? 1 : 0;
  }
};

struct ListOccupied {
  const std::uint64_t* keys;
  const std::uint32_t* number;  ///< scanned flags
  std::int64_t count, fixed;
  std::uint64_t* by_colour;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t bin = std::uint32_t(keys[i] >> 32);
    if ((i + 1 == count || std::uint32_t(keys[i + 1] >> 32) != bin) && std::uint32_t(keys[i]) >= fixed)
      by_colour[number[i]] = std::uint64_t(BinGrid::colour(bin)) << 32 | bin;
  }
};

struct SplitColours {
  const std::uint64_t* by_colour;
  std::int64_t count;
  std::uint32_t* occupied;
  std::uint32_t* colour;  ///< 28
  NACRE_HD void operator()(std::int64_t i) const {
    const int before = i == 0 ? -1 : int(by_colour[i - 1] >> 32), mine = i == count ? 27 : int(by_colour[i] >> 32);
    for (int c = before + 1; c <= mine; ++c) colour[c] = std::uint32_t(i);
    if (i < count) occupied[i] = std::uint32_t(by_colour[i]);
  }
};

}  // namespace detail

template <class Backend>
detail::Extent particle_extent(Executor<Backend>& exec, const ParticleSet& set) {
  return exec.reduce(set.count, detail::Extent{Vec3f(3e38f), Vec3f(-3e38f), 0}, detail::ExtentOf{set.position.data()},
                     detail::MergeExtents{});
}

/// How many bins are worth their memory for `n` particles.
inline std::int64_t most_bins(std::int64_t n) {
  return std::min<std::int64_t>(std::max<std::int64_t>(8 * n, 1 << 20), std::int64_t(1) << 31);
}

/// Sorts the particles into bins for steps of up to `step` h.
template <class Backend>
Bins build_bins(Executor<Backend>& exec, const ParticleSet& set, float step) {
  Arena& arena = exec.arena();
  const std::int64_t n = set.count;
  const detail::Extent extent = particle_extent(exec, set);
  Bins bins;
  bins.largest = extent.largest;
  bins.grid = make_bin_grid(extent.low, extent.high, bin_edge(extent.largest, step), most_bins(n));
  bins.order = arena.temporary<std::uint32_t>(n);
  bins.first = arena.temporary<std::uint32_t>(bins.grid.bins());
  bins.last = arena.temporary<std::uint32_t>(bins.grid.bins());
  bins.occupied = arena.temporary<std::uint32_t>(n);
  bins.first.fill_bytes(0);
  bins.last.fill_bytes(0);

  Arena::Scope scope(arena);
  Array<std::uint64_t> keys = arena.temporary<std::uint64_t>(n);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(n), colour = arena.temporary<std::uint32_t>(28);
  exec.for_each(n, detail::BinKeys{bins.grid, set.position.data(), keys.data()});
  exec.sort(keys.data(), n);
  exec.for_each(n, detail::FindBins{keys.data(), n, set.fixed, bins.order.data(), bins.first.data(), bins.last.data(),
                                    number.data()});
  const std::int64_t occupied = exec.exclusive_scan(number.data(), number.data(), n);
  Array<std::uint64_t> by_colour = arena.temporary<std::uint64_t>(occupied);
  exec.for_each(n, detail::ListOccupied{keys.data(), number.data(), n, set.fixed, by_colour.data()});
  exec.sort(by_colour.data(), occupied);
  exec.for_each(occupied + 1, detail::SplitColours{by_colour.data(), occupied, bins.occupied.data(), colour.data()});
  const std::vector<std::uint32_t> starts = colour.download();
  for (int c = 0; c < 28; ++c) bins.colour[c] = starts[c];
  return bins;
}

}  // namespace nacre
