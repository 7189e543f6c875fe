// Nacre: the particles of a bin and of the 26 around it, copied into contiguous memory, and one team per bin to work on
// them (sec. 3.2.2, 3.3.3).
#pragma once

#include "compute/device/executor.hpp"
#include "compute/particles/bins.hpp"
#include "compute/particles/near_list.hpp"

namespace nacre {

/// The copies of one colour: at most one per particle, since neighbourhoods of bins that are three apart do not
/// overlap.
struct NeighbourhoodMemory {
  float *x, *y, *z, *h, *nx, *ny, *nz;
  std::uint32_t *tag, *particle;

  NACRE_HD NeighbourhoodMemory from(std::int64_t k) const {
    return {x + k, y + k, z + k, h + k, nx + k, ny + k, nz + k, tag + k, particle + k};
  }
};

/// What the kernels over neighbourhoods share.
struct NeighbourhoodView {
  BinGrid grid;
  std::int64_t fixed;
  const std::uint32_t *order, *first, *last, *occupied;
  const std::uint64_t* start;  ///< per occupied bin: exclusive sum of the sizes of the neighbourhoods before it
  const Float4 *position, *direction;
  const std::uint32_t* interface;
  NeighbourhoodMemory memory;
};

/// One bin's neighbourhood: particles 0 .. own - 1 are those of the bin itself, of which fixed ones come first.
struct Neighbourhood {
  NeighbourhoodMemory rows;
  int own = 0, count = 0;
};

namespace detail {

/// The bin around bin `centre` that is k-th in turn; the centre comes first.
NACRE_HD inline Int3 around(const Int3& centre, int k) {
  const int at = k == 0 ? 13 : k <= 13 ? k - 1 : k;
  return centre + Int3(at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1);
}

struct NeighbourhoodSizes {
  NeighbourhoodView view;
  std::uint64_t* size;
  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 centre = view.grid.bin_of(view.occupied[i]);
    std::uint64_t n = 0;
    for (int k = 0; k < 27; ++k) {
      const Int3 b = around(centre, k);
      if (!view.grid.has(b)) continue;
      const std::uint32_t bin = view.grid.number(b);
      n += view.last[bin] - view.first[bin];
    }
    size[i] = n;
  }
};

}  // namespace detail

/// Copies the neighbourhood of the occupied bin `item` behind those of its colour that come before it.
NACRE_HD inline Neighbourhood copy_neighbourhood(Team& team, const NeighbourhoodView& view, std::int64_t item,
                                                 std::int64_t first_of_colour) {
  Neighbourhood result;
  result.rows = view.memory.from(std::int64_t(view.start[item] - view.start[first_of_colour]));
  const Int3 centre = view.grid.bin_of(view.occupied[item]);
  for (int k = 0; k < 27; ++k) {
    const Int3 b = detail::around(centre, k);
    if (!view.grid.has(b)) continue;
    const std::uint32_t bin = view.grid.number(b), first = view.first[bin];
    const int n = int(view.last[bin] - first);
    if (n == 0) continue;
    const NeighbourhoodMemory to = result.rows.from(result.count);
    team.each(n, [&](int j) {
      const std::uint32_t i = view.order[first + j];
      const Float4 p = view.position[i], d = view.direction[i];
      to.x[j] = p.x, to.y[j] = p.y, to.z[j] = p.z, to.h[j] = p.w;
      to.nx[j] = d.x, to.ny[j] = d.y, to.nz[j] = d.z;
      to.tag[j] = view.interface[i] | (i < view.fixed ? Relation::fixed : 0);
      to.particle[j] = i;
    });
    result.count += n;
    if (k == 0) result.own = n;
  }
  return result;
}

/// Of a neighbourhood, the particles that one of them may feel at any position of its next step, in the team's scratch.
/// There is room for 256; where more are near (seeds on top of each other), sums go over as many lists as it takes.
class NearInNeighbourhood {
 public:
  static constexpr int capacity = 256;
  static constexpr std::size_t bytes = std::size_t(NearList::arrays) * capacity * sizeof(float);

  /// For particle `mine` of the neighbourhood at `at`, and positions up to `step` * at.h from there.
  NACRE_HD NearInNeighbourhood(Team& team, unsigned char* scratch, const Neighbourhood& all, const Relation& relation,
                               int mine, const Mover& at, float step)
      : all_(all), relation_(relation), mine_(mine), start_(at.p), reach_(step * at.h) {
    list_.memory = reinterpret_cast<float*>(scratch);
    list_.capacity = capacity;
    end_ = gather(team, 0);
  }

  NACRE_HD PairSums sums(Team& team, const Mover& at) const {
    return over_lists(team, PairSums{}, [&] { return pair_sums(team, list_, at); });
  }
  NACRE_HD float energy(Team& team, const Mover& at) const {
    return over_lists(team, 0.0f, [&] { return pair_energy_sum(team, list_, at); });
  }

 private:
  template <class T, class Sum>
  NACRE_HD T over_lists(Team& team, T total, const Sum& sum) const {
    if (end_ == all_.count) return sum();
    for (int next = 0; next < all_.count;) {
      next = gather(team, next);
      total = total + sum();
    }
    return total;
  }

  /// Fills the list from particle `next` of the neighbourhood on, until it is full; returns where it stopped.
  NACRE_HD int gather(Team& team, int next) const {
    const NeighbourhoodMemory& rows = all_.rows;
    list_.count = 0;
    for (; next < all_.count && list_.count + 64 <= capacity; next += 64) {
      const NeighbourhoodMemory from = rows.from(next);
      const int n = all_.count - next < 64 ? all_.count - next : 64;
      const int self = mine_ - next, base = list_.count;
      const auto flag = [&](int k) {
        const float x = from.x[k] - start_.x, y = from.y[k] - start_.y, z = from.z[k] - start_.z;
        const float reach = reach_ + support * from.h[k];
        const std::uint32_t tag = from.tag[k];
        return (x * x + y * y + z * z < reach * reach) & ((tag == relation_.mine) | (tag >> 31 != 0)) & (k != self);
      };
      const auto put = [&](int k, int to) {
        const bool rim = from.tag[k] != relation_.mine;
        const bool felt = !rim || relation_.on_rim(from.tag[k]) || from.tag[k] == (relation_.mine | Relation::fixed);
        list_.put(base + to, felt ? from.x[k] : 1e9f, from.y[k], from.z[k], from.h[k], from.nx[k], from.ny[k],
                  from.nz[k], felt && rim && relation_.on_rim(from.tag[k]));
      };
      list_.count += team.compact(n, flag, put);
    }
    team.each(list_.padded() - list_.count,
              [&](int k) { list_.put(list_.count + k, 1e9f, 1e9f, 1e9f, 1, 0, 0, 0, false); });
    return next < all_.count ? next : all_.count;
  }

  const Neighbourhood& all_;
  Relation relation_;
  int mine_, end_ = 0;
  Vec3f start_;
  float reach_;
  mutable NearList list_;
};

namespace detail {

template <class Kernel>
struct OneColour {
  Kernel kernel;
  NeighbourhoodView view;
  std::int64_t first;  ///< of the colour, among the occupied bins
  std::size_t scratch_bytes() const { return kernel.scratch_bytes(); }
  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    kernel(team, copy_neighbourhood(team, view, first + i, first));
  }
};

}  // namespace detail

/// The bins of a set and the memory for their neighbourhoods, in temporary memory of the caller's scope.
template <class Backend>
class Neighbourhoods {
 public:
  Neighbourhoods(Executor<Backend>& exec, const ParticleSet& set, float step)
      : exec_(exec), bins_(build_bins(exec, set, step)) {
    Arena& arena = exec.arena();
    const std::int64_t n = set.count, occupied = bins_.colour[27];
    const auto floats = [&] { return arena.temporary<float>(n).data(); };
    const auto words = [&] { return arena.temporary<std::uint32_t>(n).data(); };
    start_ = arena.temporary<std::uint64_t>(occupied + 1);
    view_ = {bins_.grid,
             set.fixed,
             bins_.order.data(),
             bins_.first.data(),
             bins_.last.data(),
             bins_.occupied.data(),
             start_.data(),
             set.position.data(),
             set.direction.data(),
             set.interface.data(),
             {floats(), floats(), floats(), floats(), floats(), floats(), floats(), words(), words()}};
    exec.for_each(occupied, detail::NeighbourhoodSizes{view_, start_.data()});
    exec.exclusive_scan(start_.data(), start_.data(), occupied);
  }

  const Bins& bins() const { return bins_; }

  /// Runs kernel(team, neighbourhood) over all bins that hold moving particles: colour after colour, a team per bin.
  template <class Kernel>
  void for_each(const Kernel& kernel) {
    for (int c = 0; c < 27; ++c)
      exec_.for_each_team(bins_.colour[c + 1] - bins_.colour[c],
                          detail::OneColour<Kernel>{kernel, view_, bins_.colour[c]});
  }

 private:
  Executor<Backend>& exec_;
  Bins bins_;
  Array<std::uint64_t> start_;
  NeighbourhoodView view_{};
};

}  // namespace nacre
