// Nacre: simultaneous small steps of all particles of one junction order (sec. 4.1).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "compute/particles/projectors.hpp"
#include "compute/particles/refinement.hpp"
#include "compute/particles/tree_forces.hpp"
#include "compute/particles/tree_population.hpp"

namespace nacre {

/// Parameters of the tree solver.
struct TreeRule {
  float theta = 0.5f;
  float step = 1.2f;       ///< share of the Newton step
  float momentum = 0.85f;  ///< heavy ball
  float longest = 0.3f;    ///< of a step, in h
};

namespace detail {

/// One step in the tangent space, then back onto the interface.
template <class Projector>
struct MoveParticle {
  Projector projector;
  RelatedView related;
  TreeRule rule;
  int order;
  const std::uint32_t* interface;
  const Float4* gradient;
  const float* energy;
  Float4* position;
  Float4* direction;  ///< w gets the energy
  Float4* velocity;   ///< w: the interface goes on at least so far around the particle, voxels; 0: not known

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t group = interface[i];
    if (related.order[group] != order) return;
    const Float4 at = position[i], d = direction[i], g4 = gradient[i], v4 = velocity[i];
    const Vec3f p(at.x, at.y, at.z), n(d.x, d.y, d.z), g(g4.x, g4.y, g4.z);
    const auto tangential = [&](const Vec3f& v) { return order == 2 ? v - n * dot(n, v) : n * dot(n, v); };
    // In a plane the neighbours' stiffness is shared by two directions.
    const float stiffness = (order == 2 ? 0.5f : 1.0f) * g4.w;
    Vec3f v = tangential(Vec3f(v4.x, v4.y, v4.z)) * rule.momentum;
    if (stiffness > 0) v -= tangential(g) * (rule.step / stiffness);
    const float size = length(v), most = rule.longest * at.w;
    if (size > most) v *= most / size;
    EmbeddedPoint on;
    if (!arrives(group, p, v, at.w, v4.w, on)) {  // at the rim: a shorter step, or none
      v *= 0.25f;
      if (!arrives(group, p, v, at.w, v4.w, on)) {
        velocity[i] = {0, 0, 0, 0};
        direction[i].w = energy[i];
        return;
      }
    }
    // Tangents of a curve are kept pointing the same way.
    const float sign = order == 1 && dot(on.direction, n) < 0 ? -1.0f : 1.0f;
    position[i] = {on.p.x, on.p.y, on.p.z, on.h};
    direction[i] = {sign * on.direction.x, sign * on.direction.y, sign * on.direction.z, energy[i]};
    velocity[i] = {v.x, v.y, v.z, on.margin};
  }

 private:
  NACRE_HD bool arrives(std::uint32_t group, const Vec3f& p, const Vec3f& v, float h, float margin,
                        EmbeddedPoint& on) const {
    if (!projector.project(group, p + v, h, on, margin - margin_slope * length(v)) || on.margin < 0) return false;
    const Vec3f off = on.p - p - v;
    return dot(off, off) < h * h;
  }
};

/// Energy in units of 2^-20, so that its sum does not depend on the order.
struct EnergyOf {
  RelatedView related;
  const std::uint32_t* interface;
  const float* energy;
  int order;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const {
    if (related.order[interface[i]] != order) return 0;
    const float e = energy[i];
    return std::uint64_t((e < 1000 ? e : 1000.0f) * 1048576.0f);
  }
};

struct IsOfOrder {
  RelatedView related;
  const std::uint32_t* interface;
  int order;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return related.order[interface[i]] == order ? 1 : 0; }
};

}  // namespace detail

/// Moves the particles of one junction order at a time; those of lower orders are felt and stay. Particles are kept in
/// the tree's order, in two sets that are swapped.
class TreeSolver {
 public:
  template <class Backend>
  TreeSolver(Executor<Backend>& exec, std::int64_t capacity, std::int64_t interfaces, float volume_extent)
      : TreeSolver(exec.arena(), capacity, interfaces, volume_extent) {}

  /// `Memory` is an Arena, or an AllocationPlan that finds out how much the solver would take.
  template <class Memory>
  TreeSolver(Memory& memory, std::int64_t capacity, std::int64_t interfaces, float volume_extent)
      : tree_(memory, capacity, interfaces), scale_(65535.0f / volume_extent) {
    for (ParticleSet& set : set_) set = allocate_particle_set(memory, capacity);
    for (Array<Float4>& v : velocity_) v = memory.template permanent<Float4>(capacity);
    key_ = memory.template permanent<std::uint64_t>(capacity);
    number_ = memory.template permanent<std::uint32_t>(capacity);
    gradient_ = memory.template permanent<Float4>(capacity);
    energy_ = memory.template permanent<float>(capacity);
    energy_sum_ = memory.template permanent<std::uint64_t>(1);
    spacing_ = memory.template permanent<float>(std::max<std::int64_t>(interfaces, 1));
  }

  ParticleSet& particles() { return set_[0]; }
  const ParticleSet& particles() const { return set_[0]; }
  Array<Float4>& velocity() { return velocity_[0]; }
  const Tree& tree() const { return tree_; }
  TreeView view(float theta) const { return tree_.view(set_[0], theta); }

  /// Sorts the particles and builds the tree again.
  template <class Backend>
  void rebuild(Executor<Backend>& exec) {
    ParticleSet &from = set_[0], &to = set_[1];
    const std::int64_t n = from.count;
    const int bits =
        std::min(64, 3 * TreeView::bits + int(std::bit_width(std::uint64_t(tree_.interfaces()))));  // of keys
    exec.repeat(rebuilding_, [&] {
      exec.for_each(n,
                    detail::TreeKey{from.position.data(), from.interface.data(), scale_, key_.data(), number_.data()});
      exec.sort_pairs(key_.data(), number_.data(), n, bits);
      exec.for_each(n, detail::GatherParticles{number_.data(), from.position.data(), from.direction.data(),
                                               from.interface.data(), velocity_[0].data(), to.position.data(),
                                               to.direction.data(), to.interface.data(), velocity_[1].data()});
      tree_.launch_build(exec, key_, n);
    });
    to.count = n;
    swap_sets();
    tree_.read_sizes();
    tree_.summarise(exec, set_[0]);
  }

  /// Energies, forces; returns the mean energy of the particles of this order.
  template <class Backend>
  double forces(Executor<Backend>& exec, const RelatedView& related, int order, float theta, std::int64_t movers) {
    launch_forces(exec, related, order, theta);
    return mean_energy(movers);
  }

  /// `forces`, then `move` by them; returns what `forces` does.
  template <class Backend, class Projector>
  double iterate(Executor<Backend>& exec, const Projector& projector, const RelatedView& related, int order,
                 const TreeRule& rule, std::int64_t movers) {
    exec.repeat(iterating_, [&] {
      launch_forces(exec, related, order, rule.theta);
      move(exec, projector, related, order, rule);
    });
    return mean_energy(movers);  // the one thing that the host waits for
  }

  /// A step from the forces. The tree's order is kept; its bounds follow.
  template <class Backend, class Projector>
  void move(Executor<Backend>& exec, const Projector& projector, const RelatedView& related, int order,
            const TreeRule& rule) {
    ParticleSet& set = set_[0];
    exec.for_each(set.count, detail::MoveParticle<Projector>{projector, related, rule, order, set.interface.data(),
                                                             gradient_.data(), energy_.data(), set.position.data(),
                                                             set.direction.data(), velocity_[0].data()});
    tree_.summarise(exec, set);
  }

  /// Splits and deletes by the energies of the last `forces`; `movers`: particles of this order. The tree is out of
  /// date after it.
  template <class Backend>
  IterationResult control(Executor<Backend>& exec, const EmbeddedProjector& projector, const RelatedView& related,
                          int order, float theta, const PopulationRule& rule, std::int64_t movers, int round) {
    const TreePopulation population{view(theta), related,          projector,      rule,
                                    order,       gradient_.data(), energy_.data(), std::uint32_t(round)};
    return control_population(exec, population, movers, set_[0], set_[1], velocity_[0], velocity_[1]);
  }

  /// How many times as far apart as the sizing field says the particles of each interface are to be, for projectors.
  const float* spacing() const { return spacing_.data(); }

  /// All interfaces are to have particles as the sizing field says.
  template <class Backend>
  void reset_spacing(Executor<Backend>& exec) {
    exec.for_each(std::int64_t(spacing_.size()), detail::ResetSpacing{spacing_.data()});
  }

  /// Keeps a quarter of the particles of this order (half on curves), twice as far apart, on interfaces that have
  /// enough; returns how many are gone. The tree is to be up to date, and is out of date after it.
  template <class Backend>
  std::int64_t thin(Executor<Backend>& exec, const RelatedView& related, int order) {
    Arena::Scope scope(exec.arena());
    ParticleSet &from = set_[0], &to = set_[1];
    const std::int64_t n = from.count;
    Array<std::uint32_t> kept = exec.arena().template temporary<std::uint32_t>(n);
    Array<std::uint32_t> start = exec.arena().template temporary<std::uint32_t>(n);
    exec.for_each(n,
                  detail::ThinParticles{view(0), related, order, from.interface.data(), kept.data(), spacing_.data()});
    to.count = exec.exclusive_scan(kept.data(), start.data(), n);
    exec.for_each(n, detail::ListKept{kept.data(), start.data(), number_.data()});
    exec.for_each(to.count, detail::GatherParticles{number_.data(), from.position.data(), from.direction.data(),
                                                    from.interface.data(), velocity_[0].data(), to.position.data(),
                                                    to.direction.data(), to.interface.data(), velocity_[1].data()});
    scale_sizes(exec, related, order, 2, to, velocity_[1]);
    swap_sets();  // last: an interruption leaves the particles as they were
    return n - set_[0].count;
  }

  /// Puts a new particle in the middle of each link between two neighbours on interfaces that were thinned; all are
  /// then as far apart as the sizing field says. The tree is to be up to date, and is out of date after it. Throws
  /// Error where there is not enough room.
  template <class Backend, class Projector>
  void refine(Executor<Backend>& exec, const RelatedView& related, const Projector& projector) {
    Arena::Scope scope(exec.arena());
    ParticleSet& set = set_[0];
    const std::int64_t n = set.count;
    const detail::LinkMiddles<Projector> links{view(0), related, projector, set.interface.data(), spacing_.data()};
    Array<std::uint32_t> to = exec.arena().template temporary<std::uint32_t>(links.most_links * n);
    Array<std::uint32_t> count = exec.arena().template temporary<std::uint32_t>(n);
    Array<std::uint32_t> start = exec.arena().template temporary<std::uint32_t>(n);
    exec.for_each(n, detail::ListLinks<Projector>{links, to.data(), count.data()});
    const std::int64_t born = exec.exclusive_scan(count.data(), start.data(), n);
    require_capacity(set, n + born);
    exec.for_each(n,
                  detail::WriteMiddles<Projector>{links, to.data(), count.data(), start.data(), n, set.position.data(),
                                                  set.direction.data(), set.interface.data(), velocity_[0].data()});
    scale_sizes(exec, related, -1, 0.5f, set, velocity_[0]);
    reset_spacing(exec);
    set.count = n + born;  // last: after an interruption there are those of before
  }

  /// How many particles are of this order.
  template <class Backend>
  std::int64_t movers(Executor<Backend>& exec, const RelatedView& related, int order) {
    return std::int64_t(exec.reduce(set_[0].count, std::uint64_t(0),
                                    detail::IsOfOrder{related, set_[0].interface.data(), order}, Add{}));
  }

 private:
  template <class Backend>
  void launch_forces(Executor<Backend>& exec, const RelatedView& related, int order, float theta) {
    ParticleSet& set = set_[0];
    exec.for_each_team(tree_.leaf_count(), LeafForces{view(theta), related, set.interface.data(), tree_.leaves(), order,
                                                      gradient_.data(), energy_.data()});
    exec.reduce_into(energy_sum_.data(), set.count, std::uint64_t(0),
                     detail::EnergyOf{related, set.interface.data(), energy_.data(), order}, Add{});
  }

  double mean_energy(std::int64_t movers) const {
    return double(energy_sum_.download()[0]) / 1048576.0 / double(std::max<std::int64_t>(movers, 1));
  }

  template <class Backend>
  void scale_sizes(Executor<Backend>& exec, const RelatedView& related, int order, float factor, ParticleSet& set,
                   Array<Float4>& velocity) {
    exec.for_each(set.count, detail::ScaleSizes{related, order, factor, spacing_.data(), set.interface.data(),
                                                set.position.data(), velocity.data()});
  }

  void swap_sets() {
    std::swap(set_[0], set_[1]);
    std::swap(velocity_[0], velocity_[1]);
  }

  Tree tree_;
  float scale_;
  ParticleSet set_[2];
  Array<Float4> velocity_[2];
  Array<std::uint64_t> key_;
  Array<std::uint32_t> number_;
  Array<Float4> gradient_;
  Array<float> energy_;
  Array<std::uint64_t> energy_sum_;
  Array<float> spacing_;  ///< per interface: 2 where particles were thinned, else 1
  Steps rebuilding_, iterating_;
};

}  // namespace nacre
