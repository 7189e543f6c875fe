// Nacre: the Delaunay cells around an edge and around a vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/meshing/delaunay.hpp"

namespace nacre {

/// Walks from cell to cell. Made to be used again, so that it allocates but once.
class CellRings {
 public:
  static constexpr std::int32_t outside = -1;

  explicit CellRings(const DelaunayCells& cells) : cells_(cells), met_(cells.vertices.size()) {}

  int corner_of(std::int32_t cell, std::uint32_t vertex) const {
    const auto& v = cells_.vertices[cell];
    return int(std::find(v.begin(), v.end(), vertex) - v.begin());
  }

  /// Cells around the edge (a, b) of cell `start`, in their order around it; `outside` stands once for all beyond the
  /// hull.
  const std::vector<std::int32_t>& around_edge(std::uint32_t a, std::uint32_t b, std::int32_t start) {
    ring_.clear();
    int i = 0;
    while (is_end(start, i, a, b)) ++i;
    const std::uint32_t first = cells_.vertices[start][i];
    std::uint32_t behind = first;  // the corner that the walk turns its back to
    std::int32_t cell = start;
    do {
      ring_.push_back(cell);
      cell = step(cell, a, b, behind);
    } while (cell != outside && cell != start);
    if (cell == start) return ring_;
    ring_.push_back(outside);
    const std::size_t middle = ring_.size();
    behind = other(start, a, b, first);
    for (cell = step(start, a, b, behind); cell != outside; cell = step(cell, a, b, behind)) ring_.push_back(cell);
    std::reverse(ring_.begin() + std::ptrdiff_t(middle), ring_.end());
    return ring_;
  }

  /// Cells at `vertex`, a corner of cell `start`, in the order in which they are met.
  const std::vector<std::int32_t>& around_vertex(std::uint32_t vertex, std::int32_t start) {
    ring_.assign(1, start);
    met_.resize(std::max(met_.size(), cells_.vertices.size()));  // cells may have been added
    met_[start] = ++turn_;
    for (std::size_t next = 0; next < ring_.size(); ++next) {
      const std::int32_t cell = ring_[next];
      for (int k = 0; k < 4; ++k) {
        const std::int32_t beyond = cells_.neighbours[cell][k];
        if (cells_.vertices[cell][k] == vertex || beyond == outside || met_[beyond] == turn_) continue;
        met_[beyond] = turn_;
        ring_.push_back(beyond);
      }
    }
    return ring_;
  }

 private:
  bool is_end(std::int32_t cell, int corner, std::uint32_t a, std::uint32_t b) const {
    return cells_.vertices[cell][corner] == a || cells_.vertices[cell][corner] == b;
  }

  /// The corner of `cell` that is none of the three given.
  std::uint32_t other(std::int32_t cell, std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    for (const std::uint32_t v : cells_.vertices[cell])
      if (v != a && v != b && v != c) return v;
    return c;
  }

  /// The cell beyond the facet opposite of corner `behind`; the corner that both share is left behind next.
  std::int32_t step(std::int32_t cell, std::uint32_t a, std::uint32_t b, std::uint32_t& behind) const {
    const std::int32_t next = cells_.neighbours[cell][corner_of(cell, behind)];
    behind = other(cell, a, b, behind);
    return next;
  }

  const DelaunayCells& cells_;
  std::vector<std::int32_t> ring_;
  std::vector<std::uint32_t> met_;  // per cell: the turn in which it was met
  std::uint32_t turn_ = 0;
};

}  // namespace nacre
