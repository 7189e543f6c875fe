// Nacre: connected groups of bad triangles, each of which can be judged by itself.
#include "compute/meshing/patches.hpp"

#include <algorithm>

#include "compute/math/disjoint_sets.hpp"
#include "compute/meshing/incidence.hpp"

namespace nacre {

Patches patches_around(const SurfaceMesh& mesh, std::span<const std::uint8_t> marked) {
  DisjointSets sets(mesh.points.size());
  std::vector<std::uint8_t> inside(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    if (!marked[t.a] && !marked[t.b] && !marked[t.c]) continue;
    sets.join(t.a, t.b);
    sets.join(t.a, t.c);
    inside[t.a] = inside[t.b] = inside[t.c] = 1;
  }
  Patches patches;
  patches.of.assign(mesh.points.size(), none);
  for (std::uint32_t v = 0; v < patches.of.size(); ++v) {
    if (!inside[v]) continue;
    const std::uint32_t first = sets.find(v);
    patches.of[v] = first == v ? patches.count++ : patches.of[first];
  }
  return patches;
}

std::vector<double> patch_fitness(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule,
                                  std::span<const std::array<std::uint32_t, 2>> touching,
                                  std::span<const std::uint32_t> patch_of, std::uint32_t count) {
  std::vector<double> least(count, best_fitness(rule));
  const auto lower = [&](std::uint32_t point, double fitness) {
    if (patch_of[point] != none) least[patch_of[point]] = std::min(least[patch_of[point]], fitness);
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    if (patch_of[c.a] == none && patch_of[c.b] == none && patch_of[c.c] == none) continue;
    const double fitness = triangle_fitness(mesh, t, order, rule);
    for (int k = 0; k < 3; ++k) lower(c[k], fitness);
  }
  for (const auto& defect : touching)
    for (const std::uint32_t point : defect) lower(point, -1);
  return least;
}

void join_patches(const SurfaceMesh& mesh, std::span<const std::uint8_t> joining,
                  std::vector<std::uint32_t>& patch_of) {
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      if (!joining[t[k]]) continue;
      for (const std::uint32_t next : {t[(k + 1) % 3], t[(k + 2) % 3]})
        if (patch_of[t[k]] == none && !joining[next]) patch_of[t[k]] = patch_of[next];
    }
}

}  // namespace nacre
