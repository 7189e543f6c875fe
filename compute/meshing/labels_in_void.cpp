// Nacre: materials of Delaunay cells in the void around a patch.
#include "compute/meshing/labels_in_void.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "compute/math/disjoint_sets.hpp"
#include "compute/meshing/interface_facets.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {

void label_void(const DelaunayCells& cells, std::span<const std::uint8_t> wanted, std::span<std::uint16_t> label) {
  const auto is_guard = [&](std::uint32_t v) { return v >= wanted.size(); };
  const auto in_void = [&](std::size_t i) { return std::ranges::any_of(cells.vertices[i], is_guard); };
  const std::vector<std::uint32_t> void_cells = select_where(label.size(), in_void);
  DisjointSets sets(void_cells.size());
  const auto number = [&](std::int32_t cell) {
    return std::uint32_t(std::ranges::lower_bound(void_cells, std::uint32_t(cell)) - void_cells.begin());
  };
  for (std::uint32_t i = 0; i < void_cells.size(); ++i) {
    const auto& v = cells.vertices[void_cells[i]];
    for (int k = 0; k < 4; ++k) {
      const auto& facet = facet_corners[k];
      const std::int32_t beyond = cells.neighbours[void_cells[i]][k];
      if (beyond >= 0 && std::ranges::any_of(facet, [&](int c) { return is_guard(v[c]); }) &&
          std::ranges::any_of(facet, [&](int c) { return !is_guard(v[c]) && wanted[v[c]] != 0; }))
        sets.join(i, number(beyond));
    }
  }
  std::map<std::uint32_t, std::map<std::uint16_t, int>> votes;
  for (std::uint32_t i = 0; i < void_cells.size(); ++i) ++votes[sets.find(i)][label[void_cells[i]]];
  for (std::uint32_t i = 0; i < void_cells.size(); ++i)
    label[void_cells[i]] =
        std::ranges::max_element(votes[sets.find(i)], {}, [](const auto& v) { return v.second; })->first;
}

}  // namespace nacre
