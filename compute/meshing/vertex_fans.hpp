// Nacre: how often the surface of a material passes through an edge or a vertex.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Count of one material's facets, or vertex fans.
struct MaterialCount {
  std::uint16_t material;
  int count;
};

/// Counts facets or vertex fans by material. Made to be used again, so that it allocates but once.
class VertexFanCounter {
 public:
  /// Facets per material among those with the given materials; the materials ascend.
  template <class Uses, class MaterialsOf>
  const std::vector<MaterialCount>& facets(const Uses& uses, const MaterialsOf& materials_of) {
    counts_.clear();
    for (const auto use : uses)
      for (const std::uint16_t m : materials_of(use)) add(m);
    std::sort(counts_.begin(), counts_.end(), [](const auto& s, const auto& t) { return s.material < t.material; });
    return counts_;
  }

  /// One facet at a vertex: its other two corners and its materials.
  struct Facet {
    std::uint32_t from, to;
    MaterialPair materials;
  };

  /// Vertex fans per material: sets of a material's facets that hang together by edges at the vertex; the materials
  /// ascend.
  const std::vector<MaterialCount>& vertex_fans(std::span<const Facet> facets) {
    counts_.clear();
    if (is_one_ring(facets)) {  // as nearly everywhere
      for (const std::uint16_t m : facets[0].materials) counts_.push_back({m, 1});
      return counts_;
    }
    for (const Facet& f : facets)
      for (const std::uint16_t m : f.materials) add(m);
    std::sort(counts_.begin(), counts_.end(), [](const auto& s, const auto& t) { return s.material < t.material; });
    for (MaterialCount& c : counts_) c.count = sets_of(c.material, facets);
    return counts_;
  }

  /// Whether the surface of a material passes more than once, at a vertex where no junction ends or passes.
  bool is_pinched(std::span<const Facet> facets) {
    const std::vector<MaterialCount>& fans = vertex_fans(facets);
    return std::any_of(fans.begin(), fans.end(), [](const MaterialCount& c) { return c.count > 1; }) &&
           !has_junction_edge(facets);
  }

 private:
  static bool has_junction_edge(std::span<const Facet> facets) {
    return std::any_of(facets.begin(), facets.end(), [&](const Facet& f) {
      return std::any_of(facets.begin(), facets.end(), [&](const Facet& g) {
        return (g.from == f.to || g.to == f.from || g.from == f.from || g.to == f.to) && g.materials != f.materials;
      });
    });
  }

  /// Whether all facets are between the same two materials, ascending, and follow each other around the vertex, once.
  static bool is_one_ring(std::span<const Facet> facets) {
    if (facets.empty() || facets[0].materials[0] >= facets[0].materials[1]) return false;
    std::uint32_t at = facets[0].from;
    for (std::size_t n = 1; n <= facets.size(); ++n) {
      const auto next = std::find_if(facets.begin(), facets.end(), [at](const Facet& f) { return f.from == at; });
      if (next == facets.end() || next->materials != facets[0].materials) return false;
      at = next->to;
      if (at == facets[0].from) return n == facets.size();
    }
    return false;
  }

  void add(std::uint16_t material) {
    for (MaterialCount& c : counts_)
      if (c.material == material) {
        ++c.count;
        return;
      }
    counts_.push_back({material, 1});
  }

  /// Index of a corner's set; the list is short, so it is searched from the front.
  std::size_t find(std::uint32_t corner) {
    std::size_t i = std::size_t(std::find(corners_.begin(), corners_.end(), corner) - corners_.begin());
    if (i == corners_.size()) {
      corners_.push_back(corner);
      parent_.push_back(i);
    }
    while (parent_[i] != i) i = parent_[i];
    return i;
  }

  int sets_of(std::uint16_t material, std::span<const Facet> facets) {
    corners_.clear();
    parent_.clear();
    for (const Facet& f : facets) {
      if (f.materials[0] != material && f.materials[1] != material) continue;
      const std::size_t s = find(f.from), t = find(f.to);
      parent_[std::max(s, t)] = std::min(s, t);
    }
    int sets = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) sets += parent_[i] == i;
    return sets;
  }

  std::vector<MaterialCount> counts_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::size_t> parent_;
};

}  // namespace nacre
