// Nacre: tetrahedra that can be replaced by others, a few at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/cell_rings.hpp"
#include "compute/meshing/improve_cells.hpp"

namespace nacre {

/// Cells with their neighbours, kept up to date through replacements. Dead cells have material 0.
class CellStore {
 public:
  using Cell = std::array<std::uint32_t, 4>;

  CellStore(MaterialCells& cells, std::size_t points);

  std::int32_t size() const { return std::int32_t(cells_.material.size()); }
  bool alive(std::int32_t cell) const { return cells_.material[cell] != 0; }
  std::uint16_t material(std::int32_t cell) const { return cells_.material[cell]; }
  const Cell& vertices(std::int32_t cell) const { return cells_.cells.vertices[cell]; }
  std::int32_t neighbour(std::int32_t cell, int k) const { return cells_.cells.neighbours[cell][k]; }

  const std::vector<std::int32_t>& around_edge(std::uint32_t a, std::uint32_t b, std::int32_t cell) {
    return rings_.around_edge(a, b, cell);
  }
  const std::vector<std::int32_t>& around_vertex(std::uint32_t vertex) {
    return rings_.around_vertex(vertex, cell_at_[vertex]);
  }

  /// Replaces `old` by `fresh`: cells of one material that fill the same room, with the same facets around it.
  void replace(std::span<const std::int32_t> old, std::span<const Cell> fresh);

  /// Drops dead cells; the others keep their order. Nothing may be asked afterwards.
  void close_ranks();

 private:
  /// A facet of a cell by its corners, ascending.
  struct Facet {
    std::array<std::uint32_t, 3> corners;
    std::int32_t cell;
    int k;  ///< its index in `cell`; -1: `cell` is beyond, or the hull
  };
  static std::array<std::uint32_t, 3> corners_of(const Cell& cell, int k);
  void link(std::vector<Facet>& facets);

  MaterialCells& cells_;
  CellRings rings_;
  std::vector<std::int32_t> cell_at_;  // per point: a cell that has it
  std::vector<std::int32_t> free_;
  std::vector<Facet> facets_;
};

}  // namespace nacre
