// Nacre: simultaneous small steps of all particles of one junction order (sec. 4.1), and control of their number.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "compute/device/random.hpp"
#include "compute/embedding/interface_grid.hpp"
#include "compute/field/sizing.hpp"
#include "compute/particles/tree_forces.hpp"

namespace nacre {

/// What the tree solver can be told.
struct TreeRule {
  float theta = 0.5f;
  float step = 1.2f;       ///< share of the Newton step (source notes: what simultaneous steps can reach)
  float momentum = 0.85f;  ///< heavy ball
  float longest = 0.3f;    ///< of a step, in h
};

/// How particles get back onto their interface: by Newton's method on the fields themselves, for the last steps ...
struct FieldGround {
  MaterialBricksView field;
  const Junction* junction;
  SizingFieldView size;
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float, EmbeddedPoint& on) const {
    JunctionPoint at;
    if (!nacre::project(field, junction[interface], p, 1, at, 0.01f)) return false;
    on = {at.p, at.direction, size(at.p), junction_margin(field, junction[interface], at.p, at.steepness)};
    return true;
  }
};

/// ... or by the closest points of the embedding (sec. 4.2.1), wherever particles are farther apart than its cells.
struct EmbeddedGround {
  InterfaceGridView grid;
  FieldGround fields;
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float h, EmbeddedPoint& on) const {
    return h * grid.cells_per_voxel < 0.9f ? fields.project(interface, p, h, on)
                                           : nacre::project(grid, interface, p, on);
  }
};

namespace detail {

/// One step in the tangent space, then back onto the interface.
template <class Ground>
struct MoveParticle {
  Ground ground;
  RelatedView related;
  TreeRule rule;
  int order;
  const std::uint32_t* interface;
  const Float4* gradient;
  const float* energy;
  Float4* place;
  Float4* direction;  ///< w gets the energy
  Float4* velocity;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t group = interface[i];
    if (related.order[group] != order) return;
    const Float4 at = place[i], d = direction[i], g4 = gradient[i], v4 = velocity[i];
    const Vec3f p(at.x, at.y, at.z), n(d.x, d.y, d.z), g(g4.x, g4.y, g4.z);
    const auto tangential = [&](const Vec3f& v) { return order == 2 ? v - n * dot(n, v) : n * dot(n, v); };
    // In a plane the neighbours' stiffness is shared by two directions.
    const float stiffness = (order == 2 ? 0.5f : 1.0f) * g4.w;
    Vec3f v = tangential(Vec3f(v4.x, v4.y, v4.z)) * rule.momentum;
    if (stiffness > 0) v -= tangential(g) * (rule.step / stiffness);
    const float size = length(v), most = rule.longest * at.w;
    if (size > most) v *= most / size;
    EmbeddedPoint on;
    if (!arrives(group, p, v, at.w, on)) {  // at the rim: a shorter step, or none
      v *= 0.25f;
      if (!arrives(group, p, v, at.w, on)) {
        velocity[i] = {0, 0, 0, 0};
        direction[i].w = energy[i];
        return;
      }
    }
    // Tangents of a curve are kept pointing the same way.
    const float sign = order == 1 && dot(on.direction, n) < 0 ? -1.0f : 1.0f;
    place[i] = {on.p.x, on.p.y, on.p.z, on.h};
    direction[i] = {sign * on.direction.x, sign * on.direction.y, sign * on.direction.z, energy[i]};
    velocity[i] = {v.x, v.y, v.z, 0};
  }

 private:
  NACRE_HD bool arrives(std::uint32_t group, const Vec3f& p, const Vec3f& v, float h, EmbeddedPoint& on) const {
    if (!ground.project(group, p + v, h, on) || on.margin < 0) return false;
    const Vec3f off = on.p - p - v;
    return dot(off, off) < h * h;
  }
};

/// Decides who is to be split or deleted (sec. 3.1.3): a random share of the deviation from the ideal energy must pass the
/// threshold. Where the number of all is far from its target, chance takes more on that side of the ideal, as many as are
/// missing or too many. A split puts the new particle where the force points, into the gap.
struct JudgeParticle {
  TreeView tree;
  RelatedView related;
  EmbeddedGround ground;
  PopulationRule rule;
  int order;
  float demand;  ///< share of the particles to be added (above 0) or deleted for the target's sake
  std::uint32_t round;
  const std::uint32_t* interface;
  const Float4* gradient;
  const float* energy;
  Float4* child;  ///< place and h of the new particle; h = 0: none
  Float4* child_direction;
  float* deletion;  ///< energy of one to be deleted, else 0

  NACRE_HD void operator()(std::int64_t i) const {
    child[i] = {0, 0, 0, 0};
    deletion[i] = 0;
    const std::uint32_t group = interface[i];
    if (related.order[group] != order) return;
    const Float4 at = tree.place[i], d = tree.direction[i];
    const float ideal = rule.ideal_energy;
    const float bias = uniform_random(rule.seed, std::uint32_t(i), round) * (energy[i] - ideal) / ideal;
    const float chance = uniform_random(rule.seed ^ 0x9e3779b9u, std::uint32_t(i), round);
    const bool less = energy[i] > ideal && chance < -demand, more = energy[i] < ideal && chance < demand;
    if (less || bias > rule.delete_above - 1 || energy[i] > rule.certain_above * ideal)
      deletion[i] = on_island(group, at) ? 0 : energy[i];
    else if (rule.may_add && (more || bias < rule.add_below - 1))
      split(i, group, at, d, more ? 4.0f : order == 1 ? 2.5f : 1.6f);
  }

 private:
  /// Is the particle on a body hardly larger than h? That needs all that it has: on a sheet, 18 others are within 2 h.
  NACRE_HD bool on_island(std::uint32_t group, const Float4& at) const {
    constexpr float needed = 12, around = 2;
    if (tree.node[group].mass() <= 2 * needed) return true;
    if (order != 2) return false;
    const Vec3f p(at.x, at.y, at.z);
    const float reach = around * at.w;
    float count = 0;
    const auto add = [&](const Float4& q, float mass) {
      const Vec3f d = Vec3f(q.x, q.y, q.z) - p;
      count += dot(d, d) < reach * reach ? mass : 0.0f;
    };
    for (std::uint32_t k = related.start[group]; k < related.start[group + 1] && count <= needed; ++k)
      tree.walk(
          related.related[k], p, p, 2 * reach,
          [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t q = first; q < last; ++q) add(tree.place[q], 1);
          },
          [&](const TreeNode& node) { add(node.centre, node.mass()); });
    return count <= needed;
  }

  /// `crowded`: the most energy that the new particle may have where it is put, in units of the ideal. In a gap of 1.6 h on
  /// a curve it has 2.5 of it; among particles that are evenly a little too far apart there is no place with less than
  /// that.
  NACRE_HD void split(std::int64_t i, std::uint32_t group, const Float4& at, const Float4& d, float crowded) const {
    const Vec3f n(d.x, d.y, d.z), p(at.x, at.y, at.z);
    Vec3f g(gradient[i].x, gradient[i].y, gradient[i].z);
    g = order == 2 ? g - n * dot(n, g) : n * dot(n, g);
    Vec3f away = -g;
    if (!(dot(g, g) > 1e-4f / (at.w * at.w))) {  // all directions alike: any will do
      const float angle = 2 * pi * uniform_random(rule.seed ^ 0x5bd1e995u, std::uint32_t(i), round);
      const Vec3f helper = std::fabs(n.x) < 0.6f ? Vec3f(1, 0, 0) : Vec3f(0, 1, 0);
      const Vec3f s = normalized(cross(n, helper)), t = cross(n, s);
      away = order == 2 ? s * std::cos(angle) + t * std::sin(angle) : n * (angle < pi ? 1.0f : -1.0f);
    }
    EmbeddedPoint on;
    if (!ground.project(group, p + normalized(away) * (0.8f * at.w), at.w, on) || on.margin < 0) return;
    const Vec3f r = on.p - p;
    if (dot(r, r) < 0.16f * at.w * at.w) return;
    // Only where there is room: its energy there must not be that of a crowd.
    const ForceSum there = force_at(tree, related, group, on.p, on.h, order == 2 ? on.direction : Vec3f());
    if (there.energy > crowded * rule.ideal_energy) return;
    child[i] = {on.p.x, on.p.y, on.p.z, on.h};
    child_direction[i] = {on.direction.x, on.direction.y, on.direction.z, there.energy};
  }
};

/// Of new particles nearer than 0.7 h to each other only the one with the least energy is made (then the lowest number);
/// of those to be deleted within 0.9 h only the one with the most is deleted.
struct SettleConflicts {
  TreeView tree;
  RelatedView related;
  int order;
  const std::uint32_t* interface;
  const Float4* child;
  const Float4* child_direction;
  const float* deletion;
  std::uint32_t* copies;  ///< 0 deleted, 1 kept, 2 split

  NACRE_HD void operator()(std::int64_t i) const {
    copies[i] = 1;
    const std::uint32_t group = interface[i];
    if (related.order[group] != order) return;
    if (deletion[i] > 0) {
      const Float4 at = tree.place[i];
      bool most = true;
      each_near(group, {at.x, at.y, at.z}, 0.9f * at.w, [&](std::uint32_t q) {
        if (q != i && near(at, tree.place[q], 0.9f) &&
            (deletion[q] > deletion[i] || (deletion[q] == deletion[i] && q < std::uint32_t(i))))
          most = false;
      });
      if (most) copies[i] = 0;
    } else if (child[i].w > 0) {
      const Float4 at = child[i];
      bool least = true;
      each_near(group, {at.x, at.y, at.z}, 1.8f * at.w, [&](std::uint32_t q) {
        if (q == i || !(child[q].w > 0) || !near(at, child[q], 0.7f)) return;
        const float mine = child_direction[i].w, other = child_direction[q].w;
        if (other < mine || (other == mine && q < std::uint32_t(i))) least = false;
      });
      if (least) copies[i] = 2;
    }
  }

 private:
  template <class Visit>
  NACRE_HD void each_near(std::uint32_t group, const Vec3f& p, float reach, const Visit& visit) const {
    TreeView exact = tree;
    exact.theta = 0;
    exact.walk(
        group, p, p, reach,
        [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t q = first; q < last; ++q) visit(q);
        },
        [](const TreeNode&) {});
  }
  NACRE_HD static bool near(const Float4& a, const Float4& b, float share) {
    const Vec3f r(a.x - b.x, a.y - b.y, a.z - b.z);
    const float h = share * (a.w < b.w ? a.w : b.w);
    return dot(r, r) < h * h;
  }
};

struct CopyPopulation {
  const std::uint32_t* copies;
  const std::uint32_t* start;
  const Float4* place;
  const Float4* direction;
  const std::uint32_t* interface;
  const Float4* velocity;
  const Float4* child;
  const Float4* child_direction;
  Float4* to_place;
  Float4* to_direction;
  std::uint32_t* to_interface;
  Float4* to_velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = start[i];
    if (copies[i] == 0) return;
    to_place[at] = place[i];
    to_direction[at] = direction[i];
    to_interface[at] = interface[i];
    to_velocity[at] = velocity[i];
    if (copies[i] < 2) return;
    to_place[at + 1] = child[i];
    to_direction[at + 1] = child_direction[i];
    to_interface[at + 1] = interface[i];
    to_velocity[at + 1] = {0, 0, 0, 0};
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

struct CountOf {
  const std::uint32_t* copies;
  std::uint32_t which;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return copies[i] == which ? 1 : 0; }
};

}  // namespace detail

/// Moves the particles of one junction order at a time; those of lower orders are felt and stay. Particles are kept in the
/// tree's order, in two sets that change places.
class TreeSolver {
 public:
  template <class Backend>
  TreeSolver(Executor<Backend>& exec, std::int64_t capacity, std::int64_t interfaces, float volume_extent)
      : tree_(exec, capacity, interfaces), scale_(65535.0f / volume_extent) {
    Arena& arena = exec.arena();
    for (ParticleSet& set : set_) {
      set.place = arena.permanent<Float4>(capacity);
      set.direction = arena.permanent<Float4>(capacity);
      set.interface = arena.permanent<std::uint32_t>(capacity);
    }
    for (Array<Float4>& v : velocity_) v = arena.permanent<Float4>(capacity);
    key_ = arena.permanent<std::uint64_t>(capacity);
    number_ = arena.permanent<std::uint32_t>(capacity);
    gradient_ = arena.permanent<Float4>(capacity);
    energy_ = arena.permanent<float>(capacity);
    energy_sum_ = arena.permanent<std::uint64_t>(1);
  }

  ParticleSet& particles() { return set_[0]; }
  const ParticleSet& particles() const { return set_[0]; }
  Array<Float4>& velocity() { return velocity_[0]; }
  const Tree& tree() const { return tree_; }
  TreeView view(float theta) const { return tree_.view(set_[0], theta); }

  /// Sorts the particles and builds the tree anew.
  template <class Backend>
  void rebuild(Executor<Backend>& exec) {
    ParticleSet &from = set_[0], &to = set_[1];
    const std::int64_t n = from.count;
    const int bits =
        std::min(64, 3 * TreeView::bits + int(std::bit_width(std::uint64_t(tree_.interfaces()))));  // of keys
    exec.repeat(rebuilding_, [&] {
      exec.for_each(n, detail::TreeKey{from.place.data(), from.interface.data(), scale_, key_.data(), number_.data()});
      exec.sort_pairs(key_.data(), number_.data(), n, bits);
      exec.for_each(n, detail::GatherParticles{number_.data(), from.place.data(), from.direction.data(),
                                               from.interface.data(), velocity_[0].data(), to.place.data(),
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
  template <class Backend, class Ground>
  double iterate(Executor<Backend>& exec, const Ground& ground, const RelatedView& related, int order,
                 const TreeRule& rule, std::int64_t movers) {
    exec.repeat(iterating_, [&] {
      launch_forces(exec, related, order, rule.theta);
      move(exec, ground, related, order, rule);
    });
    return mean_energy(movers);  // the one thing that the host waits for
  }

  /// A step from the forces. The tree's order is kept; its bounds follow.
  template <class Backend, class Ground>
  void move(Executor<Backend>& exec, const Ground& ground, const RelatedView& related, int order,
            const TreeRule& rule) {
    ParticleSet& set = set_[0];
    exec.for_each(set.count, detail::MoveParticle<Ground>{ground, related, rule, order, set.interface.data(),
                                                          gradient_.data(), energy_.data(), set.place.data(),
                                                          set.direction.data(), velocity_[0].data()});
    tree_.summarise(exec, set);
  }

  /// Splits and deletes by the energies of the last `forces`; `movers`: particles of this order. The tree is out of date
  /// after it.
  template <class Backend>
  IterationResult control(Executor<Backend>& exec, const EmbeddedGround& ground, const RelatedView& related, int order,
                          float theta, const PopulationRule& rule, std::int64_t movers, int round) {
    ParticleSet &from = set_[0], &to = set_[1];
    const std::int64_t n = from.count;
    const double missing =
        rule.target > 0 ? double(rule.target - movers) / double(std::max<std::int64_t>(movers, 1)) : 0;
    const float demand = std::fabs(missing) > PopulationRule::slack ? float(missing) : 0.0f;
    Arena::Scope scope(exec.arena());
    Arena& arena = exec.arena();
    Array<Float4> child = arena.temporary<Float4>(n), child_direction = arena.temporary<Float4>(n);
    Array<float> deletion = arena.temporary<float>(n);
    Array<std::uint32_t> copies = arena.temporary<std::uint32_t>(n), start = arena.temporary<std::uint32_t>(n);
    exec.for_each(n, detail::JudgeParticle{view(theta), related, ground, rule, order, demand, std::uint32_t(round),
                                           from.interface.data(), gradient_.data(), energy_.data(), child.data(),
                                           child_direction.data(), deletion.data()});
    exec.for_each(n, detail::SettleConflicts{view(0), related, order, from.interface.data(), child.data(),
                                             child_direction.data(), deletion.data(), copies.data()});
    const std::uint32_t total = exec.exclusive_scan(copies.data(), start.data(), n);
    if (std::int64_t(total) > from.capacity())
      throw Error("more particles than expected",
                  std::to_string(total) + " of at most " + std::to_string(from.capacity()),
                  "raise --min-size or --epsilon");
    IterationResult result;
    result.added = std::int64_t(exec.reduce(n, std::uint64_t(0), detail::CountOf{copies.data(), 2}, Add{}));
    result.deleted = std::int64_t(exec.reduce(n, std::uint64_t(0), detail::CountOf{copies.data(), 0}, Add{}));
    exec.for_each(
        n, detail::CopyPopulation{copies.data(), start.data(), from.place.data(), from.direction.data(),
                                  from.interface.data(), velocity_[0].data(), child.data(), child_direction.data(),
                                  to.place.data(), to.direction.data(), to.interface.data(), velocity_[1].data()});
    to.count = total;
    swap_sets();
    return result;
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
  Steps rebuilding_, iterating_;
};

}  // namespace nacre
