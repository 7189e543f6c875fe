// Nacre: the thesis's sparse octree as kernels see it (sec. 6.1.3-6.1.4): leaves are single cells, look-ups walk
// from the root.
#pragma once

#include <cstdint>

#include "compute/embedding/band.hpp"
#include "compute/math/morton.hpp"

namespace nacre {

/// An inner node: 32 bytes. Octants are numbered as in a Morton code, x lowest.
struct ThesisNode {
  std::uint32_t child[8];  ///< numbers of nodes, or, in the lowest nodes, of cells; `none`
};

/// Band cells in Morton order under an octree whose leaves they are. The domain has 8 << levels cells per axis, up to
/// 2^20. Every cell within `radius` of the surface is stored, knows its exact closest point, and counts as a surface
/// cell, as in the thesis: particles start in all of them, and values are deposited on all. Fewer than 2^32 - 1
/// cells.
struct ThesisOctreeView {
  static constexpr int group = 512;  ///< cells that one team works on

  int levels = 0;
  float radius = 0, quantum = 0;
  std::uint32_t root = none;  ///< the last node; `none` where there are no cells
  CellIndex cells = 0, surface_cells = 0;
  const std::uint64_t* code = nullptr;       ///< per cell: Morton code, ascending
  const CellPoint* point = nullptr;          ///< per cell
  const ThesisNode* node = nullptr;          ///< the lowest ones first, those of a height in Morton order
  const std::uint32_t* neighbour = nullptr;  ///< 6 per cell: -x, +x, -y, +y, -z, +z; `none`. Null: no index
  const std::uint32_t* touched = nullptr;    ///< a bit per cell: a triangle touches it

  NACRE_HD int size() const { return 8 << levels; }  ///< cells per axis
  NACRE_HD int depth() const { return levels + 3; }  ///< nodes on the way from the root to a cell, the root included
  NACRE_HD std::int64_t items() const { return std::int64_t((cells + group - 1) / group); }
  NACRE_HD bool touches(CellIndex cell) const { return touched[cell >> 5] >> (cell & 31) & 1; }

  /// Number of the cell at these coordinates, or `none`: a walk from the root over `depth()` nodes.
  NACRE_HD std::uint32_t locate(const Int3& c) const {
    const auto n = unsigned(size());
    if (unsigned(c.x) >= n || unsigned(c.y) >= n || unsigned(c.z) >= n) return none;
    std::uint32_t at = root;
    for (int bit = depth() - 1; bit >= 0 && at != none; --bit)
      at = node[at].child[(c.x >> bit & 1) | (c.y >> bit & 1) << 1 | (c.z >> bit & 1) << 2];
    return at;
  }

  class Cursor;

  template <class Body>
  NACRE_HD void each_cell(Team& team, std::int64_t item, const Body& body) const;
  template <class Body>
  NACRE_HD void each_surface_cell(Team& team, std::int64_t item, const Body& body) const;
};

/// Finds cells by a walk each. With the neighbour index it remembers the cell that it found last, and cells beside that
/// one take a step or three instead; where a step would lead over a cell that is not stored, it walks.
class ThesisOctreeView::Cursor {
 public:
  NACRE_HD_INLINE explicit Cursor(const ThesisOctreeView& tree) : tree_(tree) {}
  NACRE_HD_INLINE Cursor(const ThesisOctreeView& tree, const Int3& position, std::uint32_t cell)
      : tree_(tree), position_(position), cell_(cell) {}

  NACRE_HD_INLINE CellIndex find(const Int3& position) {
    return wide(tree_.neighbour ? move(position) : tree_.locate(position));
  }
  NACRE_HD_INLINE CellIndex find_surface(const Int3& position) { return find(position); }
  NACRE_HD_INLINE unsigned eight_surface(const Int3& first, CellIndex at[8]) { return eight(first, at); }

  template <class Visit>
  NACRE_HD_INLINE void each_surface_of_27(const Int3& first, const Visit& visit) {
    for (int k = 0; k < 27; ++k) {
      const CellIndex at = find(first + Int3(k % 3, k / 3 % 3, k / 9));
      if (at != no_cell) visit(k, at);
    }
  }

  NACRE_HD unsigned eight(const Int3& first, CellIndex at[8]) {
    unsigned there = 0;
    for (int k = 0; k < 8; ++k) {
      const Int3 position = first + Int3(k & 1, k >> 1 & 1, k >> 2);
      at[k] = k == 0 || !tree_.neighbour ? find(position) : wide(beside(position, k, there, at));
      there |= unsigned(at[k] != no_cell) << k;
    }
    return there;
  }

 private:
  NACRE_HD_INLINE static CellIndex wide(std::uint32_t cell) { return cell == none ? no_cell : CellIndex(cell); }

  /// Cell k of the eight: a step from one that has been found, if there is one.
  NACRE_HD_INLINE std::uint32_t beside(const Int3& position, int k, unsigned there, const CellIndex at[8]) const {
    for (int axis = 0; axis < 3; ++axis) {
      const int from = k & ~(1 << axis);
      if (from != k && there >> from & 1) return tree_.neighbour[6 * at[from] + 2 * axis + 1];
    }
    return tree_.locate(position);
  }

  NACRE_HD std::uint32_t move(const Int3& position) {
    const std::uint32_t to = step(position);
    if (to != none) {
      position_ = position;
      cell_ = to;
    }
    return to;
  }

  NACRE_HD std::uint32_t step(const Int3& position) const {
    Int3 d = position - position_;
    if (cell_ == none || unsigned(d.x + 1) > 2 || unsigned(d.y + 1) > 2 || unsigned(d.z + 1) > 2)
      return tree_.locate(position);
    std::uint32_t at = cell_;
    for (int axis = 0; axis < 3; ++axis) {
      if (d[axis] == 0) continue;
      at = tree_.neighbour[6 * std::size_t(at) + 2 * axis + (d[axis] > 0)];
      d[axis] = 0;
      if (at == none) return d == Int3{} ? none : tree_.locate(position);
    }
    return at;
  }

  const ThesisOctreeView& tree_;
  Int3 position_{};
  std::uint32_t cell_ = none;
};

template <class Body>
NACRE_HD void ThesisOctreeView::each_cell(Team& team, std::int64_t item, const Body& body) const {
  const CellIndex first = CellIndex(item) * group, rest = cells - first;
  team.each(rest < CellIndex(group) ? int(rest) : group, [&](int k) {
    const CellIndex cell = first + CellIndex(k);
    const Int3 position = morton_cell(code[cell]);
    Cursor cursor(*this, position, std::uint32_t(cell));
    body(cell, position, cursor);
  });
}

template <class Body>
NACRE_HD void ThesisOctreeView::each_surface_cell(Team& team, std::int64_t item, const Body& body) const {
  each_cell(team, item,
            [&](CellIndex cell, const Int3& position, Cursor& cursor) { body(cell, cell, position, cursor); });
}

}  // namespace nacre
