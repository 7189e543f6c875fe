// Nacre: a tetrahedron between triangles of a mesh goes from one material to another.
#include "compute/meshing/flat_tetrahedron.hpp"

#include <algorithm>
#include <utility>

namespace nacre {
namespace {

std::array<std::uint32_t, 3> sorted(const Triangle& t) {
  std::array<std::uint32_t, 3> corners = {t.a, t.b, t.c};
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Whether two triangles with the same corners run the same way round.
bool same_way(const Triangle& s, const Triangle& t) {
  return (s.a == t.a && s.b == t.b) || (s.a == t.b && s.b == t.c) || (s.a == t.c && s.b == t.a);
}

/// Ascending materials; the triangle is turned to see the first.
MaterialFacet in_order(MaterialFacet facet) {
  if (facet.materials[0] > facet.materials[1]) {
    std::swap(facet.materials[0], facet.materials[1]);
    std::swap(facet.corners.b, facet.corners.c);
  }
  return facet;
}

}  // namespace

std::optional<std::vector<MaterialFacet>> give_away(std::uint32_t u, std::uint32_t v, std::uint32_t c, std::uint32_t d,
                                                    std::span<const MaterialFacet> faces) {
  // All run the same way round as seen from inside, or all as seen from outside.
  const std::array<Triangle, 4> around = {{{u, c, v}, {u, v, d}, {u, d, c}, {v, c, d}}};
  std::array<const MaterialFacet*, 4> face{};
  for (const MaterialFacet& f : faces) {
    const auto at =
        std::find_if(around.begin(), around.end(), [&](const Triangle& t) { return sorted(t) == sorted(f.corners); });
    if (at == around.end() || face[at - around.begin()]) return {};  // none of the four, or one twice
    face[at - around.begin()] = &f;
  }
  if (!face[0] || !face[1] || (!face[2] && !face[3])) return {};

  // Which of a face's two materials is inside: the first, or the second, if it runs as in `around`.
  const auto inner = [&](int k, int side) { return same_way(face[k]->corners, around[k]) ? side : 1 - side; };
  std::array<bool, 2> may_be{};
  for (int side = 0; side < 2; ++side) {
    const std::uint16_t inside = face[0]->materials[inner(0, side)];
    may_be[side] = std::all_of(around.begin(), around.end(), [&](const Triangle& t) {
      const int k = int(&t - around.data());
      return !face[k] || face[k]->materials[inner(k, side)] == inside;
    });
  }
  if (may_be[0] == may_be[1]) return {};
  const int side = may_be[0] ? 0 : 1;
  const std::uint16_t inside = face[0]->materials[inner(0, side)], beyond = face[0]->materials[1 - inner(0, side)];
  if (face[1]->materials[1 - inner(1, side)] != beyond) return {};

  std::vector<MaterialFacet> left;
  for (int k = 2; k < 4; ++k) {
    MaterialFacet facet{around[k], {}};
    facet.materials[side] = beyond;
    facet.materials[1 - side] = face[k] ? face[k]->materials[1 - inner(k, side)] : inside;
    if (facet.materials[0] != facet.materials[1]) left.push_back(in_order(facet));
  }
  if (left.empty()) return {};
  return left;
}

}  // namespace nacre
