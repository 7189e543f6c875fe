// Nacre: where triangles of stars and facets of cells do not meet as they should.
#include "compute/meshing/star_seams.hpp"

#include <algorithm>
#include <tuple>

#include "compute/meshing/select_where.hpp"
#include "compute/meshing/vertex_fans.hpp"

namespace nacre {
namespace {

/// One side of a triangle as a material passes it.
struct Pass {
  std::uint32_t low, high;
  std::uint16_t material;
  std::int8_t sign;
  friend bool operator<(const Pass& s, const Pass& t) {
    return std::tie(s.low, s.high, s.material) < std::tie(t.low, t.high, t.material);
  }
};

}  // namespace

std::vector<EdgeFault> edge_faults(const StarMesh& mesh, std::span<const std::uint8_t> marked) {
  std::vector<Pass> passes;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k], to = mesh.triangles[i][(k + 1) % 3];
      if (!marked[from] || !marked[to]) continue;
      const auto sign = std::int8_t(from < to ? 1 : -1);
      passes.push_back({std::min(from, to), std::max(from, to), mesh.materials[i][0], sign});
      passes.push_back({std::min(from, to), std::max(from, to), mesh.materials[i][1], std::int8_t(-sign)});
    }
  std::sort(passes.begin(), passes.end());
  std::vector<EdgeFault> faults;
  for (std::size_t i = 0, k = 0; i < passes.size(); i = k) {
    int sum = 0;
    for (k = i; k < passes.size() && !(passes[i] < passes[k]); ++k) sum += passes[k].sign;
    if (sum != 0 || k - i > 2) faults.push_back({{passes[i].low, passes[i].high}, sum != 0});
  }
  return faults;
}

std::vector<std::uint32_t> at_pinched_vertices(const StarMesh& mesh, std::span<const std::uint8_t> marked) {
  struct Use {
    std::uint32_t vertex;
    VertexFanCounter::Facet facet;
  };
  std::vector<Use> uses;
  for (const std::uint32_t i : select_where(mesh.triangles.size(), [&](std::size_t i) {
         const Triangle& t = mesh.triangles[i];
         return marked[t.a] || marked[t.b] || marked[t.c];
       })) {
    const Triangle& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k)
      if (marked[t[k]]) uses.push_back({t[k], {t[(k + 1) % 3], t[(k + 2) % 3], mesh.materials[i]}});
  }
  std::stable_sort(uses.begin(), uses.end(), [](const Use& s, const Use& t) { return s.vertex < t.vertex; });
  std::vector<std::uint32_t> pinched;
  std::vector<VertexFanCounter::Facet> facets;
  VertexFanCounter counter;
  for (std::size_t i = 0, k = 0; i < uses.size(); i = k) {
    facets.clear();
    for (k = i; k < uses.size() && uses[k].vertex == uses[i].vertex; ++k) facets.push_back(uses[k].facet);
    if (counter.is_pinched(facets)) pinched.push_back(uses[i].vertex);
  }
  return pinched;
}

std::vector<std::uint32_t> at_pinched_joints(const StarMesh& mesh, std::size_t particles) {
  std::vector<std::uint8_t> marked(particles, 0);
  for (const std::uint32_t i : mesh.joined) marked[i] = 1;
  return at_pinched_vertices(mesh, marked);
}

}  // namespace nacre
