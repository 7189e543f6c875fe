// Nacre: the first particles, from the embedding (ch. 4): spread along a space-filling curve by the sizing field.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compute/device/random.hpp"
#include "compute/embedding/build_interface_grid.hpp"
#include "compute/grid/morton.hpp"
#include "compute/particles/particle_set.hpp"

namespace nacre {

namespace detail {

/// Cells along an interface, each with its share of particles. By the coarea formula a cell of edge c whose centre is d < 1
/// cells away stands for c^2 (1 - d) of a surface's area, or 3 c (1 - d) / pi of a curve's length. Particles stand
/// 2 / (sqrt 3 h^2) to an area, 1 / h to a length.
struct SeedCells {
  InterfaceGridView grid;
  const std::uint8_t* order;  ///< per interface
  const std::uint32_t* brick_coarse;
  int wanted;  ///< junction order

  NACRE_HD float share(std::int64_t i) const {
    const std::uint32_t interface = grid.brick_interface[i / 64];
    if (order[interface] != wanted) return 0;
    const Float4 o = store(load(grid.cell[i])), d = grid.direction(i);
    if (!(o.w >= 0) || !(d.w > 0)) return 0;
    const Vec3f r(o.x, o.y, o.z);
    const float cell = 1 / grid.cells_per_voxel;
    const float away = length(r);
    if (!(away < 1)) return 0;
    return wanted == 2 ? cell * cell * (1 - away) * 1.1547005f / (d.w * d.w) : 3 * cell * (1 - away) / (pi * d.w);
  }

  NACRE_HD Int3 cell(std::int64_t i) const {
    const std::uint32_t c = brick_coarse[i / 64];
    const int k = int(i % 64);
    const Int3 b{int(c % grid.coarse.x), int(c / grid.coarse.x % grid.coarse.y),
                 int(c / grid.coarse.x / grid.coarse.y)};
    return b * Int3(4) + Int3(k % 4, k / 4 % 4, k / 16);
  }
};

struct CountSeedCells {
  SeedCells cells;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const { count[i] = cells.share(i) > 0 ? 1 : 0; }
};

struct ListSeedCells {
  SeedCells cells;
  const std::uint32_t* start;
  std::uint64_t* key;
  std::uint32_t* cell;
  NACRE_HD void operator()(std::int64_t i) const {
    if (!(cells.share(i) > 0)) return;
    key[start[i]] = std::uint64_t(cells.grid.brick_interface[i / 64]) << 48 | morton(cells.cell(i));
    cell[start[i]] = std::uint32_t(i);
  }
};

/// Shares in units of 2^-24, so that their running sum is exact; times `scale`.
struct SeedShares {
  SeedCells cells;
  const std::uint32_t* cell;
  double scale;
  std::uint64_t* share;
  NACRE_HD void operator()(std::int64_t i) const {
    share[i] = std::uint64_t(double(cells.share(cell[i])) * scale * 16777216.0);
  }
};

/// A cell gets as many particles as whole numbers lie in its stretch of the running sum.
struct CountSeeds {
  const std::uint64_t* sum;
  std::uint64_t total;
  std::int64_t cells;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint64_t half = 1u << 23, end = i + 1 < cells ? sum[i + 1] : total;
    count[i] = std::uint32_t(((end + half) >> 24) - ((sum[i] + half) >> 24));
  }
};

/// Seeds stand beside their cells' closest points, along the interface: two cells across a flat interface have the same one,
/// and particles at one place would never part. Those of a cell that has several spread over it.
struct WriteSeeds {
  SeedCells cells;
  const std::uint32_t* cell;
  const std::uint32_t* start;  ///< the counts scanned
  const std::uint32_t* count;
  std::int64_t first;
  Float4* place;
  Float4* direction;
  std::uint32_t* interface;
  Float4* velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    if (count[i] == 0) return;
    const std::int64_t at = cell[i];
    const Float4 o = store(load(cells.grid.cell[at])), d = cells.grid.direction(at);
    const Vec3f middle = cell_centre(cells.cell(at)) + Vec3f(o.x, o.y, o.z);
    for (std::uint32_t k = 0; k < count[i]; ++k) {
      const Vec3f p = (middle + aside(at, k, count[i], {d.x, d.y, d.z})) / cells.grid.cells_per_voxel;
      const std::int64_t to = first + start[i] + k;
      place[to] = {p.x, p.y, p.z, d.w};
      direction[to] = {d.x, d.y, d.z, 0};
      interface[to] = cells.grid.brick_interface[at / 64];
      velocity[to] = {0, 0, 0, 0};
    }
  }

 private:
  /// Up to a quarter of a cell along each axis, in the tangent space; half of it for one of several.
  NACRE_HD Vec3f aside(std::int64_t at, std::uint32_t number, std::uint32_t of, const Vec3f& direction) const {
    const float reach = of == 1 ? 0.25f : 0.5f;
    const auto random = [&](std::uint32_t axis) {
      return reach * (2 * uniform_random(1, std::uint32_t(at), 3 * number + axis) - 1);
    };
    const Vec3f r(random(0), random(1), random(2)), along = direction * dot(direction, r);
    return cells.wanted == 2 ? r - along : along;
  }
};

struct SumShares {
  SeedCells cells;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return std::uint64_t(double(cells.share(i)) * 16777216.0); }
};

}  // namespace detail

/// How many particles the sizing field asks for on the interfaces of a junction order.
template <class Backend>
double expected_particles(Executor<Backend>& exec, const InterfaceGrid& grid, const std::uint8_t* order, int wanted) {
  const detail::SeedCells cells{grid.view(), order, grid.brick_coarse.data(), wanted};
  return double(exec.reduce(grid.cells(), std::uint64_t(0), detail::SumShares{cells}, detail::AddCounts{})) /
         16777216.0;
}

/// Puts seeds of one junction order behind the particles of a set; returns how many. `scale`: times as many as the sizing
/// field asks for. Throws Error where they do not fit.
template <class Backend>
std::int64_t seed_particles(Executor<Backend>& exec, const InterfaceGrid& grid, const std::uint8_t* order, int wanted,
                            double scale, ParticleSet& set, Array<Float4>& velocity) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const detail::SeedCells cells{grid.view(), order, grid.brick_coarse.data(), wanted};
  std::int64_t n = 0;
  Array<std::uint64_t> key;
  Array<std::uint32_t> cell;
  {
    Array<std::uint32_t> start = arena.temporary<std::uint32_t>(grid.cells());
    exec.for_each(grid.cells(), detail::CountSeedCells{cells, start.data()});
    n = exec.exclusive_scan(start.data(), start.data(), grid.cells());
    if (n == 0) return 0;
    key = arena.temporary<std::uint64_t>(n);
    cell = arena.temporary<std::uint32_t>(n);
    exec.for_each(grid.cells(), detail::ListSeedCells{cells, start.data(), key.data(), cell.data()});
  }
  exec.sort_pairs(key.data(), cell.data(), n);
  Array<std::uint64_t> sum = arena.temporary<std::uint64_t>(n);
  exec.for_each(n, detail::SeedShares{cells, cell.data(), scale, sum.data()});
  const std::uint64_t total = exec.exclusive_scan(sum.data(), sum.data(), n);
  Array<std::uint32_t> count = arena.temporary<std::uint32_t>(n), start = arena.temporary<std::uint32_t>(n);
  exec.for_each(n, detail::CountSeeds{sum.data(), total, n, count.data()});
  const std::int64_t seeds = exec.exclusive_scan(count.data(), start.data(), n);
  if (set.count + seeds > set.capacity())
    throw Error("more particles than expected",
                std::to_string(set.count + seeds) + " of at most " + std::to_string(set.capacity()),
                "raise --min-size or --epsilon");
  exec.for_each(n, detail::WriteSeeds{cells, cell.data(), start.data(), count.data(), set.count, set.place.data(),
                                      set.direction.data(), set.interface.data(), velocity.data()});
  set.count += seeds;
  return seeds;
}

}  // namespace nacre
