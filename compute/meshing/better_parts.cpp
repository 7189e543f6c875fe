// Nacre: where two meshes of the same surfaces differ, the better of the two in each place.
#include "compute/meshing/better_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "compute/math/disjoint_sets.hpp"

namespace nacre {
namespace {

constexpr double least_gain = 1e-6;           // of fitness
constexpr std::int64_t most_of_a_speck = 20;  // facets: those of an icosahedron

/// A triangle as both meshes name it: the smallest corner comes first.
struct Named {
  Triangle corners;
  std::array<std::uint16_t, 2> materials;
  std::uint32_t number;  ///< in its mesh
};

bool operator<(const Named& s, const Named& t) {
  const auto name = [](const Named& n) { return std::tie(n.corners.a, n.corners.b, n.corners.c, n.materials); };
  return name(s) < name(t);
}

/// The triangles of a mesh by their names, ascending; `number` has the common number of each of its points.
std::vector<Named> named(const SurfaceMesh& mesh, std::span<const std::uint32_t> number) {
  std::vector<Named> all;
  all.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    Triangle c{number[t.a], number[t.b], number[t.c]};
    while (c.a > c.b || c.a > c.c) c = {c.b, c.c, c.a};
    all.push_back({c, mesh.materials[i], i});
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// One of the two meshes, in one part.
struct Side {
  double fitness;
  std::map<std::uint16_t, std::int64_t> facets;  ///< of each material
};

struct Part {
  Side first, second;
  bool stays = false, taken = false;
};

/// Bodies that only the first side has. Where nothing is left, one of the materials is what is around them.
std::int64_t specks(const Part& part) {
  const auto gone =
      std::ranges::count_if(part.first.facets, [&](const auto& f) { return !part.second.facets.contains(f.first); });
  return part.second.facets.empty() ? std::max<std::int64_t>(gone - 1, 0) : gone;
}

/// Whether the second side has the materials of the first, but for a body that is no more than a speck: where one has
/// no facets, its surface was closed within the part. `facets` has those that the whole mesh has of each material.
bool keeps_materials(const Part& part, std::span<const std::int64_t> facets) {
  for (const auto& [material, count] : part.second.facets)
    if (!part.first.facets.contains(material)) return false;
  for (const auto& [material, count] : part.first.facets)
    if (!part.second.facets.contains(material) && (count > most_of_a_speck || facets[material] <= count)) return false;
  return true;
}

class Comparison {
 public:
  Comparison(const JudgedMesh& first, const JudgedMesh& second, std::span<const std::uint32_t> same,
             const DefectRule& rule)
      : first_(first), second_(second), rule_(rule), number_(first.mesh.points.size()) {
    for (std::uint32_t v = 0; v < number_.size(); ++v) number_[v] = v;
    auto next = std::uint32_t(number_.size());
    for (const std::uint32_t v : same) number_of_second_.push_back(v == none ? next++ : v);
    sets_ = DisjointSets(next);
    find_differences();
  }

  BetterParts choose(std::span<const std::uint8_t> stays, std::vector<std::int64_t> facets) {
    std::map<std::uint32_t, Part> parts;
    const Side empty{best_fitness(rule_), {}};
    const auto part_of = [&](const Named& t) -> Part& {
      return parts.try_emplace(sets_.find(t.corners.a), Part{empty, empty}).first->second;
    };
    const auto add_all = [&](const std::vector<Named>& some, const JudgedMesh& of, Side Part::*side) {
      for (const Named& t : some) {
        Part& part = part_of(t);
        add(part.*side, of, t);
        for (int k = 0; k < 3; ++k) part.stays |= t.corners[k] < stays.size() && stays[t.corners[k]] != 0;
      }
    };
    add_all(only_first_, first_, &Part::first), add_all(only_second_, second_, &Part::second);
    const auto lower = [&](const JudgedMesh& mesh, std::span<const std::uint32_t> number, Side Part::*side) {
      for (const auto& ends : mesh.touching)
        for (const std::uint32_t v : ends)
          if (const auto at = parts.find(sets_.find(number[v])); at != parts.end()) (at->second.*side).fitness = -1;
    };
    lower(first_, number_, &Part::first), lower(second_, number_of_second_, &Part::second);
    for (auto& [root, part] : parts) {
      part.taken =
          !part.stays && part.second.fitness > part.first.fitness + least_gain && keeps_materials(part, facets);
      if (!part.taken) continue;
      for (const auto& [material, count] : part.first.facets) facets[material] -= count;
      for (const auto& [material, count] : part.second.facets) facets[material] += count;
    }
    BetterParts chosen;
    for (const auto& [root, part] : parts)
      if (part.taken) chosen.specks += specks(part);
    for (const Named& t : only_first_)
      if (part_of(t).taken) chosen.gone.push_back(t.number);
    for (const Named& t : only_second_)
      if (part_of(t).taken) chosen.taken.push_back(t.number);
    std::sort(chosen.gone.begin(), chosen.gone.end()), std::sort(chosen.taken.begin(), chosen.taken.end());
    return chosen;
  }

 private:
  void find_differences() {
    const std::vector<Named> a = named(first_.mesh, number_), b = named(second_.mesh, number_of_second_);
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only_first_));
    std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::back_inserter(only_second_));
    for (const auto* some : {&only_first_, &only_second_})
      for (const Named& t : *some) sets_.join(t.corners.a, t.corners.b), sets_.join(t.corners.a, t.corners.c);
  }

  void add(Side& side, const JudgedMesh& of, const Named& t) const {
    side.fitness = std::min(side.fitness, triangle_fitness(of.mesh, t.number, of.order, rule_));
    for (const std::uint16_t material : t.materials) ++side.facets[material];
  }

  const JudgedMesh &first_, &second_;
  const DefectRule rule_;
  std::vector<std::uint32_t> number_, number_of_second_;  ///< per point: in common
  std::vector<Named> only_first_, only_second_;
  DisjointSets sets_{0};
};

}  // namespace

BetterParts better_parts(const JudgedMesh& first, const JudgedMesh& second, std::span<const std::uint32_t> same,
                         std::span<const std::uint8_t> stays, std::vector<std::int64_t> facets,
                         const DefectRule& rule) {
  return Comparison(first, second, same, rule).choose(stays, std::move(facets));
}

}  // namespace nacre
