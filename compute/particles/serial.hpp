// Nacre: the serial solver of sec. 3.1, Gauss-Seidel with Levenberg-Marquardt steps: the yardstick for the other two.
#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "compute/particles/bins.hpp"
#include "compute/particles/levenberg_marquardt.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre {

namespace detail {

/// Bins as linked lists that are kept up to date while particles move; host code on the CPU device's memory.
struct LinkedBins {
  static constexpr std::uint32_t none = 0xffffffffu;
  BinGrid grid;
  std::vector<std::uint32_t> head, next, before, bin;  ///< per bin; per particle

  void insert(std::uint32_t i, const Vec3f& p) {
    const std::uint32_t to = grid.number(grid.bin(p));
    bin[i] = to, before[i] = none, next[i] = head[to];
    if (head[to] != none) before[head[to]] = i;
    head[to] = i;
  }
  void move(std::uint32_t i, const Vec3f& p) {
    if (grid.number(grid.bin(p)) == bin[i]) return;
    (before[i] == none ? head[bin[i]] : next[before[i]]) = next[i];
    if (next[i] != none) before[next[i]] = before[i];
    insert(i, p);
  }
};

/// All particles that one may feel at any position of its next step.
class NearInBins {
 public:
  template <class Set>
  void gather(const LinkedBins& bins, const Set& set, const Relation& relation, std::uint32_t mine, const Mover& at,
              float step) {
    list_.count = 0;
    const Int3 centre = bins.grid.bin(at.p);
    for (int k = 0; k < 27; ++k) {
      const Int3 b = centre + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (!bins.grid.has(b)) continue;
      for (std::uint32_t i = bins.head[bins.grid.number(b)]; i != LinkedBins::none; i = bins.next[i]) {
        const Float4 q = set.position[i];
        const Vec3f r = Vec3f(q.x, q.y, q.z) - at.p;
        const float reach = step * at.h + support * q.w;
        if (dot(r, r) >= reach * reach || i == mine) continue;
        const std::uint32_t tag = set.interface[i] | (i < set.fixed ? Relation::fixed : 0);
        const bool rim = relation.on_rim(tag);
        if (!rim && set.interface[i] != relation.mine) continue;
        if (list_.count == list_.capacity) grow();
        const Float4 d = set.direction[i];
        list_.put(list_.count++, q.x, q.y, q.z, q.w, d.x, d.y, d.z, rim);
      }
    }
    list_.pad();
  }

  PairSums sums(OneLane& lane, const Mover& at) const { return pair_sums(lane, list_, at); }
  float energy(OneLane& lane, const Mover& at) const { return pair_energy_sum(lane, list_, at); }

 private:
  void grow() {
    const int capacity = std::max(256, 2 * list_.capacity);
    std::vector<float> larger(std::size_t(NearList::arrays) * capacity);
    for (int a = 0; a < NearList::arrays; ++a)
      std::copy_n(memory_.begin() + std::ptrdiff_t(a) * list_.capacity, list_.count,
                  larger.begin() + std::ptrdiff_t(a) * capacity);
    memory_.swap(larger);
    list_.memory = memory_.data();
    list_.capacity = capacity;
  }

  std::vector<float> memory_;
  NearList list_;
};

/// Particles `first` to `last` - 1, one after the other.
template <class Surface>
struct SerialTurn {
  Surface surface;
  SolverParameters parameters;
  const Junction* table;
  float largest;
  std::int64_t fixed, first, last;
  Float4 *position, *direction;
  const std::uint32_t* interface;
  float* damping;
  LinkedBins* bins;
  NearInBins* near;

  void operator()(std::int64_t) const {
    for (std::int64_t i = first; i < last; ++i) relax(std::uint32_t(i));
  }

 private:
  void relax(std::uint32_t i) const {
    const Float4 p = position[i], d = direction[i];
    const Mover start{{p.x, p.y, p.z}, p.w, {d.x, d.y, d.z}};
    near->gather(*bins, *this, {table, interface[i]}, i, start, parameters.step);
    OneLane lane;
    alignas(16) unsigned char scratch[std::max<std::size_t>(projection_scratch<Surface>(), 1)];
    const RelaxedParticle done = relax_particle(lane, *near, scratch, surface, parameters, interface[i],
                                                table[interface[i]].order(), largest, start, damping[i]);
    const Mover& at = done.at;
    position[i] = {at.p.x, at.p.y, at.p.z, at.h};
    direction[i] = {at.direction.x, at.direction.y, at.direction.z, done.energy};
    damping[i] = done.damping;
    if (done.moved) bins->move(i, at.p);
  }
};

struct FillBins {
  const Float4* position;
  std::int64_t count;
  LinkedBins* bins;
  void operator()(std::int64_t) const {
    for (std::int64_t i = count; i-- > 0;)
      bins->insert(std::uint32_t(i), {position[i].x, position[i].y, position[i].z});
  }
};

}  // namespace detail

/// One turn for every moving particle, one after the other on one thread, in the order of the arrays; leaves each one's
/// energy in direction.w. Runs on the CPU's device only: throws Error elsewhere. Otherwise as redblack_iteration.
template <class Backend, class Surface>
IterationResult serial_iteration(Executor<Backend>& exec, ParticleSet& set, SolverState& state,
                                 const Array<Junction>& table, const Surface& surface,
                                 const SolverParameters& parameters) {
  if constexpr (!std::is_same_v<Backend, Cpu>) {
    throw Error("the serial solver runs on the CPU only", "it moves one particle at a time",
                "use `device` cpu, or another `solver`");
  } else {
    if (set.count <= set.fixed) return {};
    exec.for_each(set.count - set.fixed, detail::ReadSize<Surface>{surface, set.position.data() + set.fixed});
    const std::int64_t n = set.count;
    const detail::Extent extent = particle_extent(exec, set);
    detail::LinkedBins bins;
    bins.grid = make_bin_grid(extent.low, extent.high, bin_edge(extent.largest, parameters.step), most_bins(n));
    bins.head.assign(bins.grid.bins(), detail::LinkedBins::none);
    for (auto* of : {&bins.next, &bins.before, &bins.bin}) of->resize(n);
    exec.for_each(1, detail::FillBins{set.position.data(), n, &bins});
    detail::NearInBins near;
    const std::int64_t piece = 1024;  // between two checks of the stop flag
    for (std::int64_t first = set.fixed; first < n; first += piece)
      exec.for_each(1,
                    detail::SerialTurn<Surface>{surface, parameters, table.data(), extent.largest, set.fixed, first,
                                                std::min(first + piece, n), set.position.data(), set.direction.data(),
                                                set.interface.data(), state.damping.data(), &bins, &near});
    return {mean_energy(exec, set), 0, 0};
  }
}

}  // namespace nacre
