// Nacre: tetrahedra that can be replaced by others, a few at a time.
#include "compute/meshing/cell_store.hpp"

#include <algorithm>
#include <cassert>

namespace nacre {

CellStore::CellStore(MaterialCells& cells, std::size_t points)
    : cells_(cells), rings_(cells.cells), cell_at_(points, -1) {
  for (std::int32_t i = 0; i < size(); ++i)
    for (const std::uint32_t v : vertices(i)) cell_at_[v] = i;
}

std::array<std::uint32_t, 3> CellStore::corners_of(const Cell& cell, int k) {
  std::array<std::uint32_t, 3> corners{};
  for (int i = 0, n = 0; i < 4; ++i)
    if (i != k) corners[n++] = cell[i];
  std::sort(corners.begin(), corners.end());
  return corners;
}

void CellStore::replace(std::span<const std::int32_t> old, std::span<const Cell> fresh) {
  const std::uint16_t m = material(old[0]);
  const auto is_old = [&](std::int32_t cell) { return std::find(old.begin(), old.end(), cell) != old.end(); };
  facets_.clear();
  for (const std::int32_t cell : old)
    for (int k = 0; k < 4; ++k)
      if (const std::int32_t n = neighbour(cell, k); n < 0 || !is_old(n))
        facets_.push_back({corners_of(vertices(cell), k), n, -1});
  for (const std::int32_t cell : old) {
    cells_.material[cell] = 0;
    free_.push_back(cell);
  }
  for (const Cell& cell : fresh) {
    std::int32_t slot = size();
    if (!free_.empty()) {
      slot = free_.back();
      free_.pop_back();
    } else {
      cells_.cells.vertices.emplace_back();
      cells_.cells.neighbours.emplace_back();
      cells_.material.emplace_back();
    }
    cells_.cells.vertices[slot] = cell;
    cells_.material[slot] = m;
    for (int k = 0; k < 4; ++k) {
      facets_.push_back({corners_of(cell, k), slot, k});
      cell_at_[cell[k]] = slot;
    }
  }
  link(facets_);
}

/// Facets come in pairs with the same corners.
void CellStore::link(std::vector<Facet>& facets) {
  std::sort(facets.begin(), facets.end(), [](const Facet& s, const Facet& t) { return s.corners < t.corners; });
  const auto point_to = [&](const Facet& from, std::int32_t to) {
    if (from.cell < 0) return;
    int k = from.k;
    if (k < 0)
      for (k = 0; k < 3 && corners_of(vertices(from.cell), k) != from.corners;) ++k;
    cells_.cells.neighbours[from.cell][k] = to;
  };
  assert(facets.size() % 2 == 0);
  for (std::size_t i = 0; i + 1 < facets.size(); i += 2) {
    assert(facets[i].corners == facets[i + 1].corners);
    point_to(facets[i], facets[i + 1].cell);
    point_to(facets[i + 1], facets[i].cell);
  }
}

void CellStore::close_ranks() {
  std::vector<std::int32_t> number(std::size_t(size()), -1);
  std::int32_t kept = 0;
  for (std::int32_t i = 0; i < size(); ++i) {
    if (!alive(i)) continue;
    number[i] = kept;
    cells_.cells.vertices[kept] = cells_.cells.vertices[i];
    cells_.cells.neighbours[kept] = cells_.cells.neighbours[i];
    cells_.material[kept++] = cells_.material[i];
  }
  cells_.cells.vertices.resize(kept);
  cells_.cells.neighbours.resize(kept);
  cells_.material.resize(kept);
  for (auto& neighbours : cells_.cells.neighbours)
    for (std::int32_t& n : neighbours) n = n < 0 ? -1 : number[n];
}

}  // namespace nacre
