// Nacre: where the tree solver splits and deletes particles, all at once, by the energies and forces of its last look
// (sec. 3.1.3). The solvers of ch. 3 decide otherwise: population.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "compute/device/random.hpp"
#include "compute/particles/projectors.hpp"
#include "compute/particles/tree_forces.hpp"

namespace nacre {

/// What the decisions are made from.
struct TreePopulation {
  TreeView tree;
  RelatedView related;
  EmbeddedProjector projector;
  PopulationRule rule;
  int order;               ///< of the particles that may come and go
  const Float4* gradient;  ///< of the energy, per particle, as the forces were computed last
  const float* energy;
  std::uint32_t round;  ///< of the random numbers
};

namespace detail {

/// Decides who is to be split or deleted (sec. 3.1.3): a random share of the deviation from the ideal energy must pass
/// the threshold. Where the number of all is far from its target, chance takes more on that side of the ideal, as many
/// as are missing or too many. A split puts the new particle where the force points, into the gap.
struct JudgeParticle {
  TreeView tree;
  RelatedView related;
  EmbeddedProjector projector;
  PopulationRule rule;
  int order;
  float demand;  ///< share of the particles to be added (above 0) or deleted for the target's sake
  std::uint32_t round;
  const std::uint32_t* interface;
  const Float4* gradient;
  const float* energy;
  Float4* child;  ///< position and h of the new particle; h = 0: none
  Float4* child_direction;
  float* deletion;  ///< energy of one to be deleted, else 0

  NACRE_HD void operator()(std::int64_t i) const {
    child[i] = {0, 0, 0, 0};
    deletion[i] = 0;
    const std::uint32_t group = interface[i];
    if (related.order[group] != order) return;
    const Float4 at = tree.position[i], d = tree.direction[i];
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
            for (std::uint32_t q = first; q < last; ++q) add(tree.position[q], 1);
          },
          [&](const TreeNode& node) { add(node.centre, node.mass()); });
    return count <= needed;
  }

  /// `crowded`: the most energy that the new particle may have where it is put, in units of the ideal. In a gap of 1.6
  /// h on a curve it has 2.5 of it; among particles that are evenly a little too far apart there is nowhere less
  /// than that.
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
    if (!projector.project(group, p + normalized(away) * (0.8f * at.w), at.w, on) || on.margin < 0) return;
    const Vec3f r = on.p - p;
    if (dot(r, r) < 0.16f * at.w * at.w) return;
    // Only where there is room: its energy there must not be that of a crowd.
    const ForceSum there = force_at(tree, related, group, on.p, on.h, order == 2 ? on.direction : Vec3f());
    if (there.energy > crowded * rule.ideal_energy) return;
    child[i] = {on.p.x, on.p.y, on.p.z, on.h};
    child_direction[i] = {on.direction.x, on.direction.y, on.direction.z, there.energy};
  }
};

/// Of new particles nearer than 0.7 h to each other only the one with the least energy is made (then the lowest
/// number); of those to be deleted within 0.9 h only the one with the most is deleted.
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
      const Float4 at = tree.position[i];
      bool most = true;
      each_near(group, {at.x, at.y, at.z}, 0.9f * at.w, [&](std::uint32_t q) {
        if (q != i && near(at, tree.position[q], 0.9f) &&
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
  const Float4* position;
  const Float4* direction;
  const std::uint32_t* interface;
  const Float4* velocity;
  const Float4* child;
  const Float4* child_direction;
  Float4* to_position;
  Float4* to_direction;
  std::uint32_t* to_interface;
  Float4* to_velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = start[i];
    if (copies[i] == 0) return;
    to_position[at] = position[i];
    to_direction[at] = direction[i];
    to_interface[at] = interface[i];
    to_velocity[at] = velocity[i];
    if (copies[i] < 2) return;
    to_position[at + 1] = child[i];
    to_direction[at + 1] = child_direction[i];
    to_interface[at + 1] = interface[i];
    to_velocity[at + 1] = {0, 0, 0, 0};
  }
};

struct CountOf {
  const std::uint32_t* copies;
  std::uint32_t which;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return copies[i] == which ? 1 : 0; }
};

/// Memory of one control, per particle.
struct PopulationScratch {
  Array<Float4> child, child_direction;
  Array<float> deletion;
  Array<std::uint32_t> copies, start;

  template <class Memory>
  PopulationScratch(Memory& memory, std::int64_t n)
      : child(memory.template temporary<Float4>(n)),
        child_direction(memory.template temporary<Float4>(n)),
        deletion(memory.template temporary<float>(n)),
        copies(memory.template temporary<std::uint32_t>(n)),
        start(memory.template temporary<std::uint32_t>(n)) {}
};

/// Share of the particles that are missing (above 0) or too many for the target of a rule; 0 where that is within its
/// slack.
inline float tree_demand(const PopulationRule& rule, std::int64_t movers) {
  if (rule.target <= 0) return 0;
  const double missing = double(rule.target - movers) / double(std::max<std::int64_t>(movers, 1));
  return std::fabs(missing) > rule.slack ? float(missing) : 0.0f;
}

}  // namespace detail

/// Splits and deletes particles of a set in the tree's order, of which `movers` are of the order concerned. The new set
/// is written to `spare`, and the two swap; so do the velocities, those of new particles being zero. The tree is out of
/// date after it. Throws Error, and leaves the set as it was, where there is not enough room.
template <class Backend>
IterationResult control_population(Executor<Backend>& exec, const TreePopulation& by, std::int64_t movers,
                                   ParticleSet& set, ParticleSet& spare, Array<Float4>& velocity,
                                   Array<Float4>& spare_velocity) {
  const std::int64_t n = set.count;
  Arena::Scope scope(exec.arena());
  const detail::PopulationScratch to(exec.arena(), n);
  exec.for_each(n,
                detail::JudgeParticle{by.tree, by.related, by.projector, by.rule, by.order,
                                      detail::tree_demand(by.rule, movers), by.round, set.interface.data(), by.gradient,
                                      by.energy, to.child.data(), to.child_direction.data(), to.deletion.data()});
  TreeView exact = by.tree;
  exact.theta = 0;
  exec.for_each(n, detail::SettleConflicts{exact, by.related, by.order, set.interface.data(), to.child.data(),
                                           to.child_direction.data(), to.deletion.data(), to.copies.data()});
  const std::uint32_t total = exec.exclusive_scan(to.copies.data(), to.start.data(), n);
  require_capacity(set, total);
  IterationResult result;
  result.added = std::int64_t(exec.reduce(n, std::uint64_t(0), detail::CountOf{to.copies.data(), 2}, Add{}));
  result.deleted = std::int64_t(exec.reduce(n, std::uint64_t(0), detail::CountOf{to.copies.data(), 0}, Add{}));
  exec.for_each(n, detail::CopyPopulation{to.copies.data(), to.start.data(), set.position.data(), set.direction.data(),
                                          set.interface.data(), velocity.data(), to.child.data(),
                                          to.child_direction.data(), spare.position.data(), spare.direction.data(),
                                          spare.interface.data(), spare_velocity.data()});
  spare.count = total;
  std::swap(set, spare);
  std::swap(velocity, spare_velocity);
  return result;
}

}  // namespace nacre
