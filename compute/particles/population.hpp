// Nacre: which particles the serial and the red-black solver add and delete, so that each has the energy of its ideal
// neighbourhood (sec. 3.1.3), and how the new set is written. control.hpp runs
// it; the tree solver has a rule of its own (tree_population.hpp).
#pragma once

#include <cmath>
#include <utility>

#include "compute/device/random.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre {

/// What becomes of a particle.
enum class Fate { deleted, kept, split, spread };

/// Number of particles around one, over the ideal number, by its energy: that of the hexagonal lattice (on curves: the
/// row) with this energy, fitted to 1% between 0.6 and 3. At least 1/2.
NACRE_HD inline float local_density(float energy, float ideal_energy, int order) {
  const float least = order == 1 ? -2.26f : -3.11f;  // the minimum of the fit
  const float x = std::log(energy / ideal_energy), l = x > least ? x : least;
  const float density = std::exp(order == 1 ? l * (0.2147f + 0.0476f * l) : l * (0.4220f + 0.0679f * l));
  return density > 0.5f ? density : 0.5f;
}

/// What the whole set wants: more particles (above 0) or fewer, as the probability, over its own surplus or want, with
/// which each particle on that side gives way to it.
struct PopulationDemand {
  float more = 0;
};

/// By density: a particle at density r is deleted with the probability 1 - 1/r (split with 1/r - 1), so that the number
/// is right after one control; this where its energy is outside of [add_below, delete_above] of the ideal, or where the
/// set as a whole asks for it. One with twice that energy in a set that does not ask for fewer is squeezed in where it
/// cannot leave (between two fixed ones of a rim), and goes. Otherwise the original rule: bias = random * (E - E*) /
/// E*, split below add_below - 1, deleted above delete_above - 1. A particle without neighbours spreads; one at a point
/// stays. `random` in [0, 1).
NACRE_HD inline Fate population_fate(const PopulationRule& rule, const PopulationDemand& demand, int order,
                                     float energy, float neighbours, float random) {
  if (order == 0) return Fate::kept;
  if (!(neighbours > 0)) return rule.may_add ? Fate::spread : Fate::kept;
  const float deviation = (energy - rule.ideal_energy) / rule.ideal_energy;
  bool less = random * deviation > rule.delete_above - 1, more = random * deviation < rule.add_below - 1;
  if (rule.by_density) {
    const float surplus = 1 - 1 / local_density(energy, rule.ideal_energy, order);
    const bool far = deviation > rule.delete_above - 1 || deviation < rule.add_below - 1;
    const float share = far ? 1.0f : (surplus > 0) == (demand.more < 0) ? std::fabs(demand.more) : 0.0f;
    const bool squeezed = demand.more >= 0 && energy > 2 * rule.delete_above * rule.ideal_energy;
    less = squeezed || random < surplus * share;
    more = random < -surplus * share;
  }
  return less ? Fate::deleted : more && rule.may_add ? Fate::split : Fate::kept;
}

/// What is decided for the particles of a set before any is added or deleted; fixed ones have no entry that counts.
struct PopulationPlan {
  std::uint32_t* copies;   ///< per particle: how many will replace it, and which companions (see below)
  Float4* child_position;  ///< of the second, where there are two; more than two are placed by spread_position
  Float4* child_direction;

  /// Of an entry of `copies`: 0 to 4.
  NACRE_HD static std::uint32_t count(std::uint32_t entry) { return entry & 0xff; }
  /// Whether it asks for companion k of a lonely particle: decided once, since two kernels may round differently.
  NACRE_HD static bool has_companion(std::uint32_t entry, int k) { return entry >> (8 + k) & 1; }
  NACRE_HD static std::uint32_t with_companion(std::uint32_t entry, int k) { return (entry + 1) | 1u << (8 + k); }
};

namespace detail {

/// Puts a new particle of `interface` near p; false where the interface is not there.
template <class Surface>
NACRE_HD inline bool put_particle(const Surface& surface, std::uint32_t interface, const Vec3f& p, float reach,
                                  Float4& position, Float4& direction) {
  Vec3f on, d;
  if (!surface.project(interface, p, reach, on, d)) return false;
  position = {on.x, on.y, on.z, surface.size(on)};
  direction = {d.x, d.y, d.z, 0};
  return true;
}

/// Where the k-th of up to three companions of a lonely particle would be: around it on a surface, on both sides on a
/// curve.
template <class Surface>
NACRE_HD inline bool spread_position(const Surface& surface, const Junction& junction, std::uint32_t interface,
                                     const Float4& position, const Float4& direction, int k, Float4& to,
                                     Float4& to_direction) {
  const Vec3f p(position.x, position.y, position.z), d(direction.x, direction.y, direction.z);
  Vec3f away;
  if (junction.order() == 1 && k < 2) {
    away = d * (k == 0 ? 1.0f : -1.0f);
  } else if (junction.order() == 2) {
    Vec3f s, t;
    tangent_plane(d, s, t);
    away = k == 0 ? s : s * -0.5f + t * (k == 1 ? 0.8660254f : -0.8660254f);
  } else {
    return false;
  }
  return put_particle(surface, interface, p + away * position.w, 0.5f * position.w, to, to_direction);
}

}  // namespace detail

/// Notes what becomes of particle i; `gap` is where a second one goes when it splits.
template <class Surface>
NACRE_HD inline void plan_particle(const PopulationPlan& plan, Fate fate, const Surface& surface, const Junction* table,
                                   std::int64_t i, std::uint32_t interface, const Float4& position,
                                   const Float4& direction, const Vec3f& gap) {
  std::uint32_t copies = fate == Fate::deleted ? 0 : 1;
  if (fate == Fate::split)
    copies += detail::put_particle(surface, interface, gap, 0.5f * position.w, plan.child_position[i],
                                   plan.child_direction[i])
                  ? 1
                  : 0;
  Float4 to, to_direction;
  for (int k = 0; fate == Fate::spread && k < 3; ++k)
    if (detail::spread_position(surface, table[interface], interface, position, direction, k, to, to_direction)) {
      plan.child_position[i] = to, plan.child_direction[i] = to_direction;  // counts where it is the only one
      copies = PopulationPlan::with_companion(copies, k);
    }
  plan.copies[i] = copies;
}

namespace detail {

struct Population {
  std::int64_t added = 0, deleted = 0;
};

struct PopulationOf {
  const std::uint32_t* copies;
  NACRE_HD Population operator()(std::int64_t i) const {
    const std::int64_t n = PopulationPlan::count(copies[i]);
    return {n > 1 ? n - 1 : 0, n == 0 ? 1 : 0};
  }
};

struct AddPopulation {
  NACRE_HD Population operator()(const Population& a, const Population& b) const {
    return {a.added + b.added, a.deleted + b.deleted};
  }
};

/// Copies in the order in which the particles will be written; fixed ones are written elsewhere.
struct CopiesInOrder {
  const std::uint32_t *copies, *order;
  std::int64_t fixed;
  std::uint32_t* start;
  NACRE_HD void operator()(std::int64_t k) const {
    const std::int64_t i = order ? std::int64_t(order[k]) : k;
    start[k] = i < fixed ? 0 : PopulationPlan::count(copies[i]);
  }
};

/// The arrays of a set and what its particles carry.
template <class T>
struct ParticleRows {
  Float4 *position, *direction;
  std::uint32_t* interface;
  T* carried;
};

template <class T, class Surface>
struct WritePopulation {
  PopulationPlan plan;
  Surface surface;
  const Junction* table;
  const std::uint32_t *order, *start;
  std::int64_t fixed;
  T fresh;
  ParticleRows<T> from, to;

  NACRE_HD void operator()(std::int64_t k) const {
    const std::int64_t i = order ? std::int64_t(order[k]) : k;
    const std::uint32_t entry = i < fixed ? 1 : plan.copies[i], copies = PopulationPlan::count(entry);
    if (copies == 0) return;
    std::int64_t at = i < fixed ? i : fixed + start[k];
    const Float4 position = from.position[i], direction = from.direction[i];
    const std::uint32_t interface = from.interface[i];
    write(at, position, direction, interface, from.carried[i]);
    if (copies == 2) write(at + 1, plan.child_position[i], plan.child_direction[i], interface, fresh);
    for (int c = 0; copies > 2 && c < 3; ++c) {
      if (!PopulationPlan::has_companion(entry, c)) continue;
      Float4 child = plan.child_position[i], child_direction = plan.child_direction[i];
      spread_position(surface, table[interface], interface, position, direction, c, child, child_direction);
      write(++at, child, child_direction, interface, fresh);
    }
  }

 private:
  NACRE_HD void write(std::int64_t at, const Float4& position, const Float4& direction, std::uint32_t interface,
                      const T& carried) const {
    to.position[at] = position, to.direction[at] = direction, to.interface[at] = interface, to.carried[at] = carried;
  }
};

/// Surplus and want of the moving particles, 2^-20 of a particle.
struct Balance {
  std::int64_t surplus = 0, want = 0;
};

struct BalanceOf {
  PopulationRule rule;
  const Junction* table;
  const Float4* direction;
  const std::uint32_t* interface;
  NACRE_HD Balance operator()(std::int64_t i) const {
    const float density = local_density(direction[i].w, rule.ideal_energy, table[interface[i]].order());
    const std::int64_t surplus = std::int64_t((1 - 1 / density) * 1048576.0f);
    return {surplus > 0 ? surplus : 0, surplus < 0 ? -surplus : 0};
  }
};

struct AddBalances {
  NACRE_HD Balance operator()(const Balance& a, const Balance& b) const {
    return {a.surplus + b.surplus, a.want + b.want};
  }
};

}  // namespace detail

/// What the set wants, by the energies in direction.w; nothing where its number is within 2% of the ideal one.
template <class Backend>
PopulationDemand population_demand(Executor<Backend>& exec, const ParticleSet& set, const PopulationRule& rule,
                                   const Array<Junction>& table) {
  const std::int64_t moving = set.count - set.fixed;
  if (!rule.by_density || moving <= 0) return {};
  const detail::Balance all = exec.reduce(
      moving, detail::Balance{},
      detail::BalanceOf{rule, table.data(), set.direction.data() + set.fixed, set.interface.data() + set.fixed},
      detail::AddBalances{});
  const double more = double(all.want - all.surplus);
  if (std::fabs(more) < 0.02 * 1048576 * double(moving)) return {};
  return {float(more / double(more > 0 ? all.want : all.surplus))};
}

/// Memory for a plan, temporary in the caller's scope.
template <class Backend>
PopulationPlan make_population_plan(Executor<Backend>& exec, std::int64_t count) {
  Arena& arena = exec.arena();
  return {arena.temporary<std::uint32_t>(count).data(), arena.temporary<Float4>(count).data(),
          arena.temporary<Float4>(count).data()};
}

/// Writes the population that was planned into `spare` and swaps the two. `order`: the order in which moving particles
/// are written (all numbers below set.count; a null pointer keeps theirs). `carried` is what else particles have,
/// `fresh` what new ones have of it. Throws Error when there is not enough room; the set is then as before.
template <class Backend, class Surface, class T>
IterationResult apply_population(Executor<Backend>& exec, ParticleSet& set, ParticleSet& spare,
                                 const PopulationPlan& plan, const std::uint32_t* order, const Array<Junction>& table,
                                 const Surface& surface, Array<T>& carried, Array<T>& spare_carried, T fresh) {
  const detail::Population change = exec.reduce(set.count - set.fixed, detail::Population{},
                                                detail::PopulationOf{plan.copies + set.fixed}, detail::AddPopulation{});
  const std::int64_t count = set.count + change.added - change.deleted;
  require_capacity(set, count);
  if (change.added == 0 && change.deleted == 0) return {};
  Arena::Scope scope(exec.arena());
  Array<std::uint32_t> start = exec.arena().template temporary<std::uint32_t>(set.count);
  exec.for_each(set.count, detail::CopiesInOrder{plan.copies, order, set.fixed, start.data()});
  exec.exclusive_scan(start.data(), start.data(), set.count);
  const auto rows = [](const ParticleSet& of, const Array<T>& with) {
    return detail::ParticleRows<T>{of.position.data(), of.direction.data(), of.interface.data(), with.data()};
  };
  exec.for_each(set.count,
                detail::WritePopulation<T, Surface>{plan, surface, table.data(), order, start.data(), set.fixed, fresh,
                                                    rows(set, carried), rows(spare, spare_carried)});
  std::swap(set.position, spare.position);
  std::swap(set.direction, spare.direction);
  std::swap(set.interface, spare.interface);
  std::swap(carried, spare_carried);
  set.count = count;
  return {0, change.added, change.deleted};
}

}  // namespace nacre
