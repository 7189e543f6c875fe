// Nacre: points of a mesh divided in two, where parts of it do not hang together.
#include "compute/meshing/halves.hpp"

#include <map>

#include "compute/math/disjoint_sets.hpp"

namespace nacre {

std::vector<std::vector<std::uint32_t>> halves(const SurfaceMesh& mesh, std::span<const std::uint8_t> marked) {
  DisjointSets parts(mesh.points.size());
  for (const Triangle& t : mesh.triangles) parts.join(t.a, t.b), parts.join(t.a, t.c);
  std::map<std::uint32_t, std::vector<std::uint32_t>> points_of;
  for (std::uint32_t v = 0; v < marked.size(); ++v)
    if (marked[v]) points_of[parts.find(v)].push_back(v);
  if (points_of.size() < 2) return {};
  std::vector<std::vector<std::uint32_t>> halves(2);
  std::size_t k = 0;
  for (const auto& [part, points] : points_of) {
    std::vector<std::uint32_t>& half = halves[2 * k++ / points_of.size()];
    half.insert(half.end(), points.begin(), points.end());
  }
  return halves;
}

}  // namespace nacre
