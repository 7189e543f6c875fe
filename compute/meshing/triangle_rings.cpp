// Nacre: the triangles around particles, as the sides opposite.
#include "compute/meshing/triangle_rings.hpp"

#include <numeric>

#include "compute/meshing/incidence.hpp"

namespace nacre {

TriangleRings triangle_rings(const SurfaceMesh& mesh, std::span<const std::uint32_t> point_of,
                             std::span<const std::uint8_t> wanted, std::size_t particles) {
  const VertexTable facets_at(mesh.triangles, mesh.points.size());
  TriangleRings rings;
  rings.first.resize(particles + 1);
  for (std::size_t v = 0; v < point_of.size(); ++v)
    if (wanted[v]) rings.first[point_of[v] + 1] = std::uint32_t(facets_at.corners(v).size());
  std::partial_sum(rings.first.begin(), rings.first.end(), rings.first.begin());
  rings.edge.resize(rings.first.back());
  for (std::size_t v = 0; v < point_of.size(); ++v) {
    if (!wanted[v]) continue;
    std::uint32_t at = rings.first[point_of[v]];
    for (const std::uint32_t corner : facets_at.corners(v)) {
      const Triangle& t = mesh.triangles[corner / 3];
      rings.edge[at++] = {point_of[t[(corner + 1) % 3]], point_of[t[(corner + 2) % 3]]};
    }
  }
  return rings;
}

}  // namespace nacre
