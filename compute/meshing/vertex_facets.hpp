// Nacre: whether the facets at a vertex are the surfaces of materials as they should be.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/meshing/vertex_fans.hpp"

namespace nacre {

/// All facets at one vertex.
using VertexFacets = std::vector<VertexFanCounter::Facet>;

/// Whether surfaces touch at the vertex, and it is on no junction.
inline bool is_pinched(const VertexFacets& facets) {
  VertexFanCounter counter;
  return !facets.empty() && counter.is_pinched(facets);
}

/// Whether the surface of a material passes the vertex more than once, and more often than before.
inline bool touches_more(const VertexFacets& before, const VertexFacets& after) {
  VertexFanCounter counter;
  const std::vector<MaterialCount> fans = counter.vertex_fans(before);
  const std::vector<MaterialCount>& now = counter.vertex_fans(after);
  return std::any_of(now.begin(), now.end(), [&](const MaterialCount& is) {
    const auto was = std::find_if(fans.begin(), fans.end(), [&](const auto& f) { return f.material == is.material; });
    return is.count > std::max(1, was == fans.end() ? 0 : was->count);
  });
}

/// Whether each material has two facets at each of the vertex's edges, if any.
inline bool edges_pass_once(const VertexFacets& facets) {
  const auto passes = [&](std::uint32_t end, std::uint16_t m) {
    return std::count_if(facets.begin(), facets.end(), [&](const VertexFanCounter::Facet& f) {
      return (f.from == end || f.to == end) && (f.materials[0] == m || f.materials[1] == m);
    });
  };
  return std::all_of(facets.begin(), facets.end(), [&](const VertexFanCounter::Facet& f) {
    return passes(f.from, f.materials[0]) == 2 && passes(f.from, f.materials[1]) == 2 &&
           passes(f.to, f.materials[0]) == 2 && passes(f.to, f.materials[1]) == 2;
  });
}

}  // namespace nacre
