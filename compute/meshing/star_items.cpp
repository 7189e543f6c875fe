// Nacre: particles once for each surface that they are on.
#include "compute/meshing/star_items.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace nacre {
namespace {

/// The junctions that particles lie on, each once, and the surfaces that end there.
class Kinds {
 public:
  explicit Kinds(std::span<const Junction> junctions) : of_(junctions.size()) {
    std::unordered_map<std::uint64_t, std::uint32_t> number;
    for (std::size_t p = 0; p < junctions.size(); ++p) {
      if (p > 0 && junctions[p] == junctions[p - 1]) {
        of_[p] = of_[p - 1];
        continue;
      }
      const auto [at, is_new] = number.try_emplace(junctions[p].packed, std::uint32_t(kinds_.size()));
      if (is_new) kinds_.push_back(junctions[p]);
      of_[p] = at->second;
    }
  }

  std::size_t count() const { return kinds_.size(); }
  const Junction& junction(std::size_t kind) const { return kinds_[kind]; }
  std::uint32_t of(std::size_t particle) const { return of_[particle]; }

 private:
  std::vector<Junction> kinds_;
  std::vector<std::uint32_t> of_;  // per particle
};

/// Calls visit(a, b) for pairs of the materials of a junction, by their numbers in it.
template <class Visit>
void for_surfaces(const Junction& junction, const Visit& visit) {
  for (int a = 0; a < junction.materials(); ++a)
    for (int b = a + 1; b < junction.materials(); ++b) visit(a, b);
}

std::array<std::uint16_t, 2> pair_of(const Junction& junction, int a, int b) {
  return {std::uint16_t(junction.material(a)), std::uint16_t(junction.material(b))};
}

/// Numbers the surfaces of `items`, and puts particles into them, which is all that this fills.
void list_items(StarItems& items, const Kinds& kinds, std::span<const std::uint8_t> idle) {
  for (std::size_t k = 0; k < kinds.count(); ++k)
    for_surfaces(kinds.junction(k), [&](int a, int b) { items.materials.push_back(pair_of(kinds.junction(k), a, b)); });
  std::sort(items.materials.begin(), items.materials.end());
  items.materials.erase(std::unique(items.materials.begin(), items.materials.end()), items.materials.end());
  std::vector<std::vector<std::uint32_t>> surfaces(kinds.count());
  for (std::size_t k = 0; k < kinds.count(); ++k)
    for_surfaces(kinds.junction(k), [&](int a, int b) {
      const auto at =
          std::lower_bound(items.materials.begin(), items.materials.end(), pair_of(kinds.junction(k), a, b));
      surfaces[k].push_back(std::uint32_t(at - items.materials.begin()));
    });
  items.first.assign(items.materials.size() + 1, 0);
  std::vector<std::uint32_t> of_kind(kinds.count(), 0);
  for (std::size_t p = 0; p < idle.size(); ++p) of_kind[kinds.of(p)] += !idle[p];
  for (std::size_t k = 0; k < kinds.count(); ++k)
    for (const std::uint32_t s : surfaces[k]) items.first[s + 1] += of_kind[k];
  std::partial_sum(items.first.begin(), items.first.end(), items.first.begin());
  items.particle.resize(items.first.back()), items.surface.resize(items.first.back());
  std::vector<std::uint32_t> next(items.first.begin(), items.first.end() - 1);
  for (std::uint32_t p = 0; p < idle.size(); ++p) {
    if (idle[p]) continue;
    for (const std::uint32_t s : surfaces[kinds.of(p)]) items.particle[next[s]] = p, items.surface[next[s]++] = s;
  }
}

Vec3d normal_of(const StarParticles& particles, std::uint32_t p, const std::array<std::uint16_t, 2>& pair) {
  const Junction j = particles.junction[p];
  if (j.order() == 2) {
    const Float4 n = particles.direction[p];
    return normalized(Vec3d(n.x, n.y, n.z));
  }
  Vec3d normal;
  for_surfaces(j, [&](int a, int b) {
    if (pair_of(j, a, b) == pair) normal = normalized(particles.difference(p, a, b));
  });
  return normal;
}

/// The item of a particle on the surface between two materials.
std::uint32_t find_item(const StarItems& items, const std::array<std::uint16_t, 2>& pair, std::uint32_t particle) {
  const std::size_t s =
      std::size_t(std::lower_bound(items.materials.begin(), items.materials.end(), pair) - items.materials.begin());
  const auto begin = items.particle.begin();
  return std::uint32_t(std::lower_bound(begin + items.first[s], begin + items.first[s + 1], particle) - begin);
}

/// Rims run along curves, or against them: the surface between the first and the third material lies to the left of a
/// curve, the two others to its right.
void add_rims(StarItems& items, const std::vector<CurveNode>& nodes) {
  std::vector<std::array<std::uint32_t, 3>> on(nodes.size());  // its items on the three surfaces
  tbb::parallel_for(std::size_t(0), nodes.size(), [&](std::size_t n) {
    Junction curve;
    curve.packed = nodes[n].curve;
    if (!nodes[n].is_idle())
      for_surfaces(curve, [&](int a, int b) {
        on[n][std::size_t(a + b - 1)] = find_item(items, pair_of(curve, a, b), nodes[n].particle);
      });
  });
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const CurveNode& node = nodes[n];
    if (node.is_broken()) items.broken.push_back(node.particle);
    if (node.next == none || node.is_idle()) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool along = k == 1;
      const std::uint32_t from = on[along ? n : node.next][k], to = on[along ? node.next : n][k];
      items.next[from] = to, items.previous[to] = from;
    }
  }
  std::sort(items.broken.begin(), items.broken.end());
}

}  // namespace

StarItems star_items(const StarParticles& particles) {
  const std::vector<CurveNode> nodes = link_curves(particles);
  std::vector<std::uint8_t> idle(particles.count(), 0);
  for (const CurveNode& node : nodes) idle[node.particle] = idle[node.particle] || node.is_idle();
  StarItems items;
  list_items(items, Kinds(particles.junction), idle);
  const std::size_t n = items.particle.size();
  items.position.resize(n), items.normal.resize(n), items.size.resize(n);
  items.next.assign(n, none), items.previous.assign(n, none);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const std::uint32_t p = items.particle[i];
    items.position[i] = particles.point(p);
    items.normal[i] = normal_of(particles, p, items.materials[items.surface[i]]);
    items.size[i] = particles.position[p].w;
  });
  add_rims(items, nodes);
  return items;
}

}  // namespace nacre
