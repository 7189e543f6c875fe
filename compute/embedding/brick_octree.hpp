// Nacre: the two-level sparse octree as kernels see it: bricks of 8^3 cells found by Morton code, cells by bit mask.
#pragma once

#include <cstdint>

#include "compute/embedding/band.hpp"
#include "compute/math/bits.hpp"
#include "compute/math/morton.hpp"

namespace nacre {

/// Which cells of a brick exist, and the number of the first one. Bit 8 y + x of word z is cell (x, y, z). The cells of
/// a brick are numbered in that order; those that the surface passes through have numbers of their own in the same
/// order.
struct CellMask {
  std::uint64_t word[8];
  CellIndex first;          ///< number of the brick's first cell
  std::uint16_t before[8];  ///< how many of its cells are in lower words

  NACRE_HD_INLINE CellIndex find(int x, int y, int z) const {
    const std::uint64_t bit = std::uint64_t(1) << (8 * y + x);
    if (!(word[z] & bit)) return no_cell;
    return first + before[z] + count_bits(word[z] & (bit - 1));
  }

  /// Cells (x, y, z) to (x + n - 1, y, z), all of this brick: a bit for each that exists, and the number of the first
  /// of these.
  NACRE_HD_INLINE unsigned row(int x, int y, int z, int n, CellIndex& number) const {
    const int shift = 8 * y + x;
    number = first + before[z] + count_bits(word[z] & ((std::uint64_t(1) << shift) - 1));
    return unsigned(word[z] >> shift) & ((1u << n) - 1);
  }

  /// Cells (x, y, z) and (x + 1, y, z), x < 7; returns two bits for those that exist.
  NACRE_HD_INLINE unsigned pair(int x, int y, int z, CellIndex at[2]) const {
    const unsigned there = row(x, y, z, 2, at[0]);
    at[1] = at[0] + (there & 1);
    return there;
  }

  NACRE_HD int count() const { return before[7] + count_bits(word[7]); }

  /// Fills `before` from the words.
  NACRE_HD void number(CellIndex first_cell) {
    first = first_cell;
    int n = 0;
    for (int z = 0; z < 8; ++z) {
      before[z] = std::uint16_t(n);
      n += count_bits(word[z]);
    }
  }
};

struct OctreeBrick {
  CellMask band;     ///< cells within the radius
  CellMask surface;  ///< those that a triangle touches
};

/// An inner node of the linear octree; the children that exist are contiguous in the next level, in Morton order.
struct OctreeNode {
  std::uint32_t first;     ///< node of the next level, or brick
  std::uint32_t children;  ///< 8 bits
};

/// Bricks near the surface in Morton order, under an octree of `levels` levels of nodes (root: level 0). The domain has
/// 8 << levels cells per axis, up to 2^20. A cell of the band lies within `radius` of the surface and stores its exact
/// closest point. Nothing here is as large as the domain, or as a face of it.
struct BrickOctreeView {
  static constexpr int width = 8;  ///< cells per brick and axis

  int levels = 0;
  float radius = 0, quantum = 0;
  std::uint32_t brick_count = 0;
  CellIndex cells = 0, surface_cells = 0;
  const std::uint64_t* brick_code = nullptr;  ///< per brick, ascending
  const OctreeBrick* brick = nullptr;
  const std::uint32_t* neighbour = nullptr;    ///< 27 per brick, x fastest, itself in the middle; `none`
  const OctreeNode* node = nullptr;            ///< level after level
  const std::uint32_t* level_start = nullptr;  ///< levels + 1 entries: first node of each level
  const CellPoint* point = nullptr;            ///< per cell
  const std::uint64_t* list_start = nullptr;   ///< brick_count + 1: into `list`
  const std::uint32_t* list = nullptr;         ///< triangles that touch each brick, ascending
  const std::uint32_t* chosen = nullptr;       ///< bricks that kernels run on; null: all
  std::uint32_t chosen_count = 0;

  NACRE_HD int size() const { return width << levels; }  ///< cells per axis
  NACRE_HD std::int64_t items() const { return chosen ? chosen_count : brick_count; }
  NACRE_HD_INLINE std::int64_t brick_of_item(std::int64_t item) const { return chosen ? chosen[item] : item; }

  /// Number of the brick at these brick coordinates, or `none`: descends from the root.
  NACRE_HD std::uint32_t locate(const Int3& b) const {
    const int bricks = 1 << levels;
    if (unsigned(b.x) >= unsigned(bricks) || unsigned(b.y) >= unsigned(bricks) || unsigned(b.z) >= unsigned(bricks))
      return none;
    std::uint32_t at = 0;
    for (int level = 0; level < levels; ++level) {
      const OctreeNode n = node[level_start[level] + at];
      const int shift = levels - 1 - level;
      const int child = (b.x >> shift & 1) | (b.y >> shift & 1) << 1 | (b.z >> shift & 1) << 2;
      if (!(n.children >> child & 1)) return none;
      at = n.first + count_bits(n.children & ((1u << child) - 1));
    }
    return at;
  }

  class Cursor;

  template <class Body>
  NACRE_HD void each_cell(Team& team, std::int64_t item, const Body& body) const;
  template <class Body>
  NACRE_HD void each_surface_cell(Team& team, std::int64_t item, const Body& body) const;
};

/// Remembers the brick of the last cell that was looked up.
class BrickOctreeView::Cursor {
 public:
  NACRE_HD_INLINE explicit Cursor(const BrickOctreeView& tree) : tree_(tree) {}
  NACRE_HD_INLINE Cursor(const BrickOctreeView& tree, std::uint32_t brick)
      : tree_(tree), position_(morton_cell(tree.brick_code[brick])), brick_(brick) {}

  NACRE_HD_INLINE CellIndex find(const Int3& cell) { return find(cell, &OctreeBrick::band); }
  NACRE_HD_INLINE CellIndex find_surface(const Int3& cell) { return find(cell, &OctreeBrick::surface); }
  NACRE_HD_INLINE unsigned eight(const Int3& first, CellIndex at[8]) { return eight(first, at, &OctreeBrick::band); }
  NACRE_HD_INLINE unsigned eight_surface(const Int3& first, CellIndex at[8]) {
    return eight(first, at, &OctreeBrick::surface);
  }

  /// Calls visit(k, number) for the surface cells among the 3^3 from `first`, x fastest.
  template <class Visit>
  NACRE_HD_INLINE void each_surface_of_27(const Int3& first, const Visit& visit) {
    const std::uint32_t* around = bricks_around(first);
    const Int3 in{first.x & 7, first.y & 7, first.z & 7};
    for (int row = 0; row < 9; ++row) {
      const int y = in.y + row % 3, z = in.z + row / 3;
      if (around && in.x < 6) {  // the row is in one brick
        const std::uint32_t b = around[3 * (y >> 3) + 9 * (z >> 3)];
        if (b == none) continue;
        CellIndex number;
        const unsigned there = tree_.brick[b].surface.row(in.x, y & 7, z & 7, 3, number);
        for (int x = 0; x < 3; ++x)
          if (there >> x & 1) visit(3 * row + x, number++);
        continue;
      }
      for (int x = 0; x < 3; ++x) {
        const CellIndex number = find_near(around, first, {in.x + x, y, z}, &OctreeBrick::surface);
        if (number != no_cell) visit(3 * row + x, number);
      }
    }
  }

  /// Number of the brick that contains `cell`, or `none`.
  NACRE_HD_INLINE std::uint32_t brick_of(const Int3& cell) {
    const Int3 position{cell.x >> 3, cell.y >> 3, cell.z >> 3};
    if (position == position_) return brick_;
    return move(position);
  }

 private:
  NACRE_HD std::uint32_t move(const Int3& position) {
    const Int3 d = position - position_;
    const bool next = brick_ != none && unsigned(d.x + 1) < 3 && unsigned(d.y + 1) < 3 && unsigned(d.z + 1) < 3;
    position_ = position;
    brick_ = next ? tree_.neighbour[27 * std::size_t(brick_) + 13 + d.x + 3 * d.y + 9 * d.z] : tree_.locate(position);
    return brick_;
  }

  NACRE_HD_INLINE CellIndex find(const Int3& cell, CellMask OctreeBrick::*which) {
    const std::uint32_t b = brick_of(cell);
    return b == none ? no_cell : (tree_.brick[b].*which).find(cell.x & 7, cell.y & 7, cell.z & 7);
  }

  NACRE_HD_INLINE unsigned eight(const Int3& first, CellIndex at[8], CellMask OctreeBrick::*which) {
    const int x = first.x & 7, y = first.y & 7, z = first.z & 7;
    if (x < 7 && y < 7 && z < 7) {
      const std::uint32_t b = brick_of(first);
      if (b == none) return 0;
      const CellMask& mask = tree_.brick[b].*which;
      return mask.pair(x, y, z, at) | mask.pair(x, y + 1, z, at + 2) << 2 | mask.pair(x, y, z + 1, at + 4) << 4 |
             mask.pair(x, y + 1, z + 1, at + 6) << 6;
    }
    const std::uint32_t* around = bricks_around(first);
    unsigned there = 0;
    for (int k = 0; k < 8; ++k) {
      at[k] = find_near(around, first, {x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)}, which);
      there |= unsigned(at[k] != no_cell) << k;
    }
    return there;
  }

  /// The table of the 27 bricks around the one that contains `cell`, which is the middle entry; null if it does not
  /// exist.
  NACRE_HD_INLINE const std::uint32_t* bricks_around(const Int3& cell) {
    const std::uint32_t b = brick_of(cell);
    return b == none ? nullptr : tree_.neighbour + 27 * std::size_t(b) + 13;
  }

  /// Cell `in`, 0..15 per axis from the lower corner of the brick of `first`, through its table.
  NACRE_HD_INLINE CellIndex find_near(const std::uint32_t* around, const Int3& first, const Int3& in,
                                      CellMask OctreeBrick::*which) {
    if (!around) return find(Int3(first.x & ~7, first.y & ~7, first.z & ~7) + in, which);
    const std::uint32_t b = around[(in.x >> 3) + 3 * (in.y >> 3) + 9 * (in.z >> 3)];
    return b == none ? no_cell : (tree_.brick[b].*which).find(in.x & 7, in.y & 7, in.z & 7);
  }

  const BrickOctreeView& tree_;
  Int3 position_{-4, -4, -4};
  std::uint32_t brick_ = none;
};

namespace detail {
/// Calls visit(number, x, y, z) for the cells of a mask; on CUDA the lanes of a team divide them.
template <class Visit>
NACRE_HD void each_masked(Team& team, const CellMask& mask, const Visit& visit) {
#if defined(__CUDA_ARCH__)
  team.each(512, [&](int k) {
    const std::uint64_t bit = std::uint64_t(1) << (k & 63), word = mask.word[k >> 6];
    if (word & bit) visit(mask.first + mask.before[k >> 6] + count_bits(word & (bit - 1)), k & 7, k >> 3 & 7, k >> 6);
  });
#else
  (void)team;
  CellIndex number = mask.first;
  for (int z = 0; z < 8; ++z)
    for (std::uint64_t rest = mask.word[z]; rest; rest &= rest - 1) {
      const int k = __builtin_ctzll(rest);
      visit(number++, k & 7, k >> 3, z);
    }
#endif
}
}  // namespace detail

template <class Body>
NACRE_HD void BrickOctreeView::each_cell(Team& team, std::int64_t item, const Body& body) const {
  const std::int64_t b = brick_of_item(item);
  const Int3 corner = morton_cell(brick_code[b]) * Int3(width);
  Cursor cursor(*this, std::uint32_t(b));
  detail::each_masked(team, brick[b].band, [&](CellIndex cell, int x, int y, int z) {
    Cursor own = cursor;
    body(cell, corner + Int3(x, y, z), own);
  });
}

template <class Body>
NACRE_HD void BrickOctreeView::each_surface_cell(Team& team, std::int64_t item, const Body& body) const {
  const std::int64_t b = brick_of_item(item);
  const Int3 corner = morton_cell(brick_code[b]) * Int3(width);
  const OctreeBrick& here = brick[b];
  Cursor cursor(*this, std::uint32_t(b));
  detail::each_masked(team, here.surface, [&](CellIndex surface_cell, int x, int y, int z) {
    Cursor own = cursor;
    body(surface_cell, here.band.find(x, y, z), corner + Int3(x, y, z), own);
  });
}

}  // namespace nacre
