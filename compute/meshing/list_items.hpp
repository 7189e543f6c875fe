// Nacre: items listed on a device, and the rims of surfaces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/embedding/sorted_pairs.hpp"
#include "compute/meshing/curve_links.hpp"
#include "compute/meshing/list_where.hpp"
#include "compute/meshing/star_items.hpp"
#include "compute/meshing/star_particles.hpp"

namespace nacre {

namespace detail {

struct HasGradients {
  const Junction* junction;
  std::uint32_t* has;
  NACRE_HD void operator()(std::int64_t p) const { has[p] = junction[p].order() < 2 ? 1 : 0; }
};

/// Two materials, the lower one in the upper half.
NACRE_HD inline std::uint32_t pair_of(const Junction& junction, int a, int b) {
  return junction.material(a) << 16 | junction.material(b);
}

/// The surfaces that each particle is on, as pairs of materials.
struct SurfacesOf {
  const Junction* junction;
  CurveNodesView nodes;
  template <class Visit>
  NACRE_HD void operator()(std::int64_t p, const Visit& visit) const {
    const Junction j = junction[p];
    for (int k = 0; k < CurveNodesView::count_of(j); ++k)
      if (nodes.of(p, k).is_idle()) return;
    for (int a = 0; a < j.materials(); ++a)
      for (int b = a + 1; b < j.materials(); ++b) visit(std::uint64_t(pair_of(j, a, b)));
  }
};

/// Where items are written.
struct ItemsToPut {
  Vec3d* position;
  Vec3d* normal;
  double* size;
  std::uint32_t* particle;
  std::uint32_t* surface;
  std::uint32_t* next;
  std::uint32_t* previous;
};

/// `surface` of `to` holds how many surfaces begin before each item.
struct PutItems {
  StarParticlesView particles;
  const std::uint64_t* key;  // pair of materials, particle
  std::int64_t n;
  ItemsToPut to;
  std::uint32_t* first;  // per surface and one more: its first item
  std::uint32_t* pair;   // per surface
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t p = std::uint32_t(key[i]), materials = std::uint32_t(key[i] >> 32);
    const bool begins = i == 0 || key[i - 1] >> 32 != materials;
    if (!begins) --to.surface[i];
    const std::uint32_t s = to.surface[i];
    if (begins) first[s] = std::uint32_t(i), pair[s] = materials;
    if (i + 1 == n) first[s + 1] = std::uint32_t(n);
    to.position[i] = particles.point(p), to.size[i] = particles.size(p), to.particle[i] = p;
    to.normal[i] = normal_of(p, materials);
  }

 private:
  NACRE_HD Vec3d normal_of(std::uint32_t p, std::uint32_t materials) const {
    const Junction j = particles.junction[p];
    if (j.order() == 2) {
      const Float4 d = particles.direction[p];
      return normalized(Vec3d(d.x, d.y, d.z));
    }
    for (int a = 0; a < j.materials(); ++a)
      for (int b = a + 1; b < j.materials(); ++b)
        if (pair_of(j, a, b) == materials) return normalized(particles.difference(p, a, b));
    return {};
  }
};

/// Rims run along curves, or against them: the surface between the first and the third material lies to the left of a
/// curve, the two others to its right.
struct LinkItems {
  const Junction* junction;
  CurveNodesView nodes;
  const std::uint32_t* first;  // per surface
  const std::uint32_t* pair;   // per surface
  ItemsToPut items;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t p = items.particle[i], s = items.surface[i];
    std::uint32_t next = none, previous = none;        // items,
    std::uint32_t next_by = none, previous_by = none;  // and the nodes that their links begin at
    for (int k = 0; k < CurveNodesView::count_of(junction[p]); ++k) {
      const std::uint32_t number = nodes.listed[nodes.first[p] + k];
      const CurveNode& node = nodes.node[number];
      bool along = false;
      if (!is_of(node, pair[s], along)) continue;
      if (node.next != none)
        put(along ? next : previous, along ? next_by : previous_by, item(s, nodes.node[node.next].particle), number);
      if (node.previous != none)
        put(along ? previous : next, along ? previous_by : next_by, item(s, nodes.node[node.previous].particle),
            node.previous);
    }
    items.next[i] = next, items.previous[i] = previous;
  }

 private:
  /// Where two links claim an item, as they do where gradients are wrong, that of the higher node gets it.
  NACRE_HD static void put(std::uint32_t& to, std::uint32_t& by, std::uint32_t item, std::uint32_t node) {
    if (by == none || node > by) to = item, by = node;
  }

  /// Whether the surface ends at a curve, and runs along it.
  NACRE_HD static bool is_of(const CurveNode& node, std::uint32_t materials, bool& along) {
    Junction curve;
    curve.packed = node.curve;
    along = pair_of(curve, 0, 2) == materials;
    return along || pair_of(curve, 0, 1) == materials || pair_of(curve, 1, 2) == materials;
  }

  NACRE_HD std::uint32_t item(std::uint32_t s, std::uint32_t particle) const {
    std::uint32_t low = first[s], high = first[s + 1];
    while (high - low > 1) {
      const std::uint32_t middle = low + (high - low) / 2;
      if (items.particle[middle] <= particle)
        low = middle;
      else
        high = middle;
    }
    return low;
  }
};

struct IsBroken {
  const CurveNode* node;
  NACRE_HD bool operator()(std::int64_t n) const { return node[n].is_broken(); }
};

struct ParticleOfNode {
  const CurveNode* node;
  const std::uint32_t* number;
  std::uint32_t* particle;
  NACRE_HD void operator()(std::int64_t k) const { particle[k] = node[number[k]].particle; }
};

}  // namespace detail

/// Items on a device.
class DeviceItems {
 public:
  DeviceItems() = default;
  /// With room for `most`, in permanent memory.
  DeviceItems(Arena& arena, std::size_t most)
      : position_(arena.permanent<Vec3d>(most)),
        normal_(arena.permanent<Vec3d>(most)),
        size_(arena.permanent<double>(most)),
        particle_(arena.permanent<std::uint32_t>(most)),
        surface_(arena.permanent<std::uint32_t>(most)),
        next_(arena.permanent<std::uint32_t>(most)),
        previous_(arena.permanent<std::uint32_t>(most)) {}

  /// Those of `n` particles instead of what there was.
  template <class Backend>
  void list(Executor<Backend>& exec, const StarParticlesView& particles, std::int64_t n);

  std::size_t room() const { return position_.size(); }
  std::size_t count() const { return first_.empty() ? 0 : first_.back(); }
  const std::vector<MaterialPair>& materials() const { return materials_; }  ///< per surface, ascending
  const std::vector<std::uint32_t>& first() const { return first_; }  ///< per surface and one more, if there are any
  /// `first`: the same on the device.
  StarItemsView view(const std::uint32_t* first) const {
    return {position_.data(), normal_.data(), size_.data(),     particle_.data(),
            surface_.data(),  next_.data(),   previous_.data(), first};
  }
  /// As the host reads them, until the next call of this or `list`.
  StarItems seen_by_host();

 private:
  struct Copies {
    std::vector<Vec3d> position, normal;
    std::vector<double> size;
    std::vector<std::uint32_t> particle, surface, next, previous;
  };

  detail::ItemsToPut to_put() const {
    return {position_.data(), normal_.data(), size_.data(),    particle_.data(),
            surface_.data(),  next_.data(),   previous_.data()};
  }

  Array<Vec3d> position_, normal_;
  Array<double> size_;
  Array<std::uint32_t> particle_, surface_, next_, previous_;
  std::vector<MaterialPair> materials_;
  std::vector<std::uint32_t> first_, broken_;
  Copies copies_;  // for a host that does not share the memory
};

template <class Backend>
void DeviceItems::list(Executor<Backend>& exec, const StarParticlesView& particles, std::int64_t n) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  materials_.clear(), first_.clear(), broken_.clear();
  if (n == 0) return;
  const CurveNodes nodes = link_curves(exec, particles, n);
  if (nodes.count() > 0) {
    const auto broken = list_where(exec, nodes.count(), detail::IsBroken{nodes.node.data()});
    const auto particle = arena.template temporary<std::uint32_t>(broken.size());
    exec.for_each(std::int64_t(broken.size()),
                  detail::ParticleOfNode{nodes.node.data(), broken.data(), particle.data()});
    broken_ = particle.download();
    std::sort(broken_.begin(), broken_.end());
  }
  const Array<std::uint64_t> key = sorted_pairs(exec, n, detail::SurfacesOf{particles.junction, nodes.view()});
  const auto count = std::int64_t(key.size());
  if (count == 0) return;
  exec.for_each(count, detail::HeadFlag{key.data(), surface_.data()});
  const std::size_t surfaces = exec.exclusive_scan(surface_.data(), surface_.data(), count);
  const auto first = arena.template temporary<std::uint32_t>(surfaces + 1);
  const auto pair = arena.template temporary<std::uint32_t>(surfaces);
  exec.for_each(count, detail::PutItems{particles, key.data(), count, to_put(), first.data(), pair.data()});
  exec.for_each(count, detail::LinkItems{particles.junction, nodes.view(), first.data(), pair.data(), to_put()});
  first_ = first.download();
  for (const std::uint32_t materials : pair.download())
    materials_.push_back({std::uint16_t(materials >> 16), std::uint16_t(materials)});
}

inline StarItems DeviceItems::seen_by_host() {
  const std::size_t n = count();
  return {position_.seen_by_host(n, copies_.position),
          normal_.seen_by_host(n, copies_.normal),
          size_.seen_by_host(n, copies_.size),
          particle_.seen_by_host(n, copies_.particle),
          surface_.seen_by_host(n, copies_.surface),
          next_.seen_by_host(n, copies_.next),
          previous_.seen_by_host(n, copies_.previous),
          materials_,
          first_,
          broken_};
}

}  // namespace nacre
