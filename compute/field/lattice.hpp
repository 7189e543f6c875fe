// Nacre: the cells on which distances and sizes are known, in tiles of which only those near interfaces are stored.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/device/team.hpp"
#include "compute/field/build_material_bricks.hpp"

namespace nacre {

/// Cells as large as the voxels, or larger where particles will be far apart.
struct Lattice {
  Int3 cells{};
  Vec3f spacing{1, 1, 1};  ///< voxels

  NACRE_HD std::int64_t count() const { return std::int64_t(cells.x) * cells.y * cells.z; }
  NACRE_HD std::int64_t number(int x, int y, int z) const { return (std::int64_t(z) * cells.y + y) * cells.x + x; }
  NACRE_HD Int3 cell(std::int64_t i) const {
    return {int(i % cells.x), int(i / cells.x % cells.y), int(i / cells.x / cells.y)};
  }
  NACRE_HD Vec3f centre(const Int3& c) const { return Vec3f(c.x + 0.5f, c.y + 0.5f, c.z + 0.5f) * spacing; }
  NACRE_HD bool holds(const Int3& c) const { return is_within(c, cells); }
  bool operator==(const Lattice&) const = default;

  /// Tiles of 8^3 cells.
  static constexpr int tile = 8;
  static constexpr int tile_cells = tile * tile * tile;
  NACRE_HD Int3 tiles() const {
    return {(cells.x + tile - 1) / tile, (cells.y + tile - 1) / tile, (cells.z + tile - 1) / tile};
  }
  NACRE_HD std::int64_t tile_count() const { return std::int64_t(tiles().x) * tiles().y * tiles().z; }
  NACRE_HD std::int64_t tile_number(const Int3& t) const {
    const Int3 n = tiles();
    return (std::int64_t(t.z) * n.y + t.y) * n.x + t.x;
  }
  NACRE_HD Int3 tile_at(std::int64_t t) const {
    const Int3 n = tiles();
    return {int(t % n.x), int(t / n.x % n.y), int(t / n.x / n.y)};
  }
  /// Of a cell in its tile.
  NACRE_HD static int place(int x, int y, int z) { return (z * tile + y) * tile + x; }
};

/// The lattice of about `spacing` voxels over a volume, never finer than its voxels.
inline Lattice lattice_over(const MaterialBricks& b, float spacing) {
  Lattice lattice;
  for (int axis = 0; axis < 3; ++axis) {
    lattice.spacing[axis] = std::max(spacing, 1 / b.cells_per_unit[axis]);
    const double extent = double(b.blocks[axis] * block_size) / b.cells_per_unit[axis];
    lattice.cells[axis] = std::max(2, int(std::ceil(extent / lattice.spacing[axis] - 1e-3)));  // for interpolation
  }
  return lattice;
}

/// A lattice of which some tiles are stored: what is known of their cells lies tile by tile, x fastest in each. Cells
/// of a stored tile that the lattice does not hold are there and have no meaning.
struct TilesView {
  Lattice lattice;
  const std::uint32_t* stored = nullptr;  ///< per tile: which of the stored ones it is, or `none`
  const std::uint32_t* tile = nullptr;    ///< per stored tile: its number among all

  /// Where what is known of a cell lies; -1 where that is not stored.
  NACRE_HD std::int64_t slot(const Int3& c) const {
    constexpr unsigned n = Lattice::tile;
    const auto x = unsigned(c.x), y = unsigned(c.y), z = unsigned(c.z);
    const std::uint32_t s = stored[lattice.tile_number({int(x / n), int(y / n), int(z / n)})];
    return s == none ? -1 : std::int64_t(s) * Lattice::tile_cells + Lattice::place(int(x % n), int(y % n), int(z % n));
  }
  /// The cell behind a slot, which the lattice need not hold.
  NACRE_HD Int3 cell(std::int64_t slot) const {
    constexpr int n = Lattice::tile;
    const int k = int(slot % Lattice::tile_cells);
    return lattice.tile_at(tile[slot / Lattice::tile_cells]) * Int3(n) + Int3(k % n, k / n % n, k / (n * n));
  }
  /// The stored tile beside a tile, or `none`.
  NACRE_HD std::uint32_t beside(const Int3& tile_at, const Int3& step) const {
    const Int3 t = tile_at + step;
    return is_within(t, lattice.tiles()) ? stored[lattice.tile_number(t)] : none;
  }
  /// body(cell, place in the tile) for the cells of stored tile `s`, shared out among the team.
  template <class Body>
  NACRE_HD void each_in_tile(Team& team, std::int64_t s, const Body& body) const {
    constexpr int n = Lattice::tile;
    const Int3 low = lattice.tile_at(tile[s]) * Int3(n);
    team.each(Lattice::tile_cells, [&](int k) {
      const Int3 c = low + Int3(k % n, k / n % n, k / (n * n));
      if (lattice.holds(c)) body(c, k);
    });
  }
};

/// The same, in permanent memory.
struct LatticeTiles {
  Lattice lattice;
  Array<std::uint32_t> stored, tile;
  TilesView view() const { return {lattice, stored.data(), tile.data()}; }
  std::int64_t count() const { return std::int64_t(tile.size()); }
  std::int64_t slots() const { return count() * Lattice::tile_cells; }
  std::int64_t bytes() const { return std::int64_t(stored.bytes() + tile.bytes()); }
};

namespace detail {

/// Marks the tiles that can be within reach of an interface: those with a block that lists materials not farther away
/// than `margin`.
struct MarkNearTiles {
  MaterialBricksView field;
  const std::uint32_t* listed;
  Lattice lattice;
  float margin;  ///< voxels
  std::uint32_t* near;

  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 block = field.block(listed[i]), last = lattice.tiles() - Int3(1);
    Int3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const float per_tile = 1 / (float(Lattice::tile) * lattice.spacing[axis]);
      const float edge = float(block_size) / field.cells_per_unit[axis];
      low[axis] = int(max((float(block[axis]) * edge - margin) * per_tile - 1, 0.0f));
      high[axis] = int((float(block[axis] + 1) * edge + margin) * per_tile + 1);
    }
    high = min(high, last);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          if (reaches(x, block, 0) && reaches(y, block, 1) && reaches(z, block, 2))
            relaxed_store(near + lattice.tile_number({x, y, z}), 1);
  }

 private:
  NACRE_HD bool reaches(int tile, const Int3& block, int axis) const {
    const float wide = Lattice::tile * lattice.spacing[axis], per_block = field.cells_per_unit[axis] / block_size;
    return int(max((float(tile) * wide - margin) * per_block, 0.0f)) <= block[axis] &&
           block[axis] <= int((float(tile + 1) * wide + margin) * per_block);
  }
};

/// Marks the tiles around stored ones, too.
struct MarkTilesAround {
  TilesView tiles;
  int rings;
  std::uint32_t* marked;
  NACRE_HD void operator()(std::int64_t s) const {
    const Int3 t = tiles.lattice.tile_at(tiles.tile[s]);
    const Int3 low = max(t - Int3(rings), Int3(0)), high = min(t + Int3(rings), tiles.lattice.tiles() - Int3(1));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) relaxed_store(marked + tiles.lattice.tile_number({x, y, z}), 1);
  }
};

/// Numbers the marked tiles. `stored` holds the marks before.
struct NumberTiles {
  const std::uint32_t* number;
  std::uint32_t* stored;
  std::uint32_t* tile;
  NACRE_HD void operator()(std::int64_t t) const {
    if (stored[t]) tile[number[t]] = std::uint32_t(t);
    stored[t] = stored[t] ? number[t] : none;
  }
};

/// Stores the tiles that `mark` marks with 1.
template <class Backend, class Mark>
LatticeTiles store_tiles(Executor<Backend>& exec, const Lattice& lattice, const Mark& mark) {
  Arena& arena = exec.arena();
  const std::int64_t tiles = lattice.tile_count();
  if (tiles >= std::int64_t(1) << 32) throw Error("volume too large", "more than 2^32 tiles of cells", "crop it");
  LatticeTiles result;
  result.lattice = lattice;
  result.stored = arena.permanent<std::uint32_t>(tiles);
  result.stored.fill_bytes(0);
  mark(result.stored.data());
  Arena::Scope scope(arena);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(tiles);
  const std::uint32_t stored = exec.exclusive_scan(result.stored.data(), number.data(), tiles);
  result.tile = arena.permanent<std::uint32_t>(stored);
  exec.for_each(tiles, NumberTiles{number.data(), result.stored.data(), result.tile.data()});
  return result;
}

}  // namespace detail

/// The tiles that can be within `reach` voxels of an interface.
template <class Backend>
LatticeTiles tiles_near(Executor<Backend>& exec, const MaterialBricks& b, const Lattice& lattice, float reach) {
  // A list says what is within 4 voxels of its block, and an interface point lies up to 2.5 from its boundary voxel.
  const float margin = std::max(reach + 3.5f - 4, 0.0f);
  return detail::store_tiles(exec, lattice, [&](std::uint32_t* near) {
    exec.for_each(std::int64_t(b.listed.size()),
                  detail::MarkNearTiles{b.view(), b.listed.data(), lattice, margin, near});
  });
}

/// `tiles` and so many rings of tiles around them.
template <class Backend>
LatticeTiles tiles_around(Executor<Backend>& exec, const LatticeTiles& tiles, int rings) {
  return detail::store_tiles(exec, tiles.lattice, [&](std::uint32_t* marked) {
    exec.for_each(tiles.count(), detail::MarkTilesAround{tiles.view(), rings, marked});
  });
}

}  // namespace nacre
