// Nacre: the materials of a patch's cells where it has no particles.
#include "compute/meshing/patch_voids.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <vector>

#include "compute/math/disjoint_sets.hpp"
#include "compute/meshing/interface_facets.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

bool too_long(std::span<const Vec3d> points, std::span<const double> reach, const std::array<std::uint32_t, 3>& facet) {
  for (const std::uint32_t i : facet) {
    if (i >= reach.size() || !(reach[i] > 0)) continue;
    for (const std::uint32_t k : facet)
      if (length(points[k] - points[i]) > reach[i]) return true;
  }
  return false;
}

}  // namespace

void unify_voids(std::span<const Vec3d> points, const DelaunayCells& cells, std::span<const double> reach,
                 std::span<const std::uint8_t> known, std::span<std::uint16_t> label) {
  DisjointSets voids(cells.vertices.size());
  std::vector<std::uint8_t> joined(cells.vertices.size(), 0);
  for (std::size_t i = 0; i < cells.vertices.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      const std::int32_t beside = cells.neighbours[i][k];
      const auto& v = cells.vertices[i];
      const auto& [a, b, c] = facet_corners[k];
      if (beside <= std::int32_t(i) || !too_long(points, reach, {v[a], v[b], v[c]})) continue;
      voids.join(std::uint32_t(i), std::uint32_t(beside));
      joined[i] = joined[std::size_t(beside)] = 1;
    }
  const std::vector<std::uint32_t> in_void = select_where(joined.size(), [&](std::size_t i) { return joined[i] != 0; });
  struct Votes {
    int known = 0, all = 0;
    bool operator<(const Votes& other) const { return std::tie(known, all) < std::tie(other.known, other.all); }
  };
  std::map<std::uint32_t, std::map<std::uint16_t, Votes>> votes;  // by the first cell of a void, and by label
  for (const std::uint32_t i : in_void) {
    Votes& mine = votes[voids.find(i)][label[i]];
    ++mine.all, mine.known += known[i];
  }
  for (const std::uint32_t i : in_void) {
    const auto& of = votes[voids.find(i)];
    label[i] =
        std::max_element(of.begin(), of.end(), [](const auto& s, const auto& t) { return s.second < t.second; })->first;
  }
}

}  // namespace nacre
