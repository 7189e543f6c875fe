// Nacre: the stars of items, of which only those are found again whose surroundings have changed.
#include "compute/meshing/star_finder.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "compute/meshing/select_where.hpp"
#include "compute/meshing/star_settling.hpp"

namespace nacre {
namespace {

constexpr std::size_t dear_share = 4;     // where more than this part has changed, finding all again costs less
constexpr std::uint32_t look_ahead = 16;  // items that may have gone or come next to each other in the order

std::uint32_t follow(const std::vector<std::uint32_t>& to, std::uint32_t i) { return i == none ? none : to[i]; }

/// Which items of `now` were there before, alike in all that a star reads of its own item, and in the same order.
struct Known {
  std::vector<std::uint32_t> old_of, new_of;

  Known(const StarItems& before, const std::vector<Star>& stars, const StarItems& now)
      : old_of(now.count(), none), new_of(before.count(), none) {
    tbb::parallel_for(std::size_t(0), now.materials.size(), [&](std::size_t s) {
      const auto at = std::lower_bound(before.materials.begin(), before.materials.end(), now.materials[s]);
      if (at == before.materials.end() || *at != now.materials[s]) return;
      const auto t = std::size_t(at - before.materials.begin());
      walk(before, before.first[t], before.first[t + 1], now, now.first[s], now.first[s + 1]);
    });
    // Which of two in one place is left out depends on more than the place.
    for (std::uint32_t old = 0; old < before.count(); ++old)
      if (stars[old].hidden && new_of[old] != none) forget(new_of[old]);
    const std::vector<std::uint32_t> differ = select_where(now.count(), [&](std::size_t i) {
      const std::uint32_t old = old_of[i];
      if (old == none) return false;
      const std::uint32_t next = before.next[old], previous = before.previous[old];
      return follow(new_of, next) != now.next[i] || follow(new_of, previous) != now.previous[i] ||
             (next == none) != (now.next[i] == none) || (previous == none) != (now.previous[i] == none);
    });
    for (const std::uint32_t i : differ) forget(i);
  }

 private:
  void forget(std::uint32_t i) { new_of[old_of[i]] = none, old_of[i] = none; }

  /// Through both lists of one surface, side by side.
  void walk(const StarItems& before, std::uint32_t old, std::uint32_t old_end, const StarItems& now, std::uint32_t i,
            std::uint32_t end) {
    const auto alike = [&](std::uint32_t o, std::uint32_t n) {
      return o < old_end && n < end && before.position[o] == now.position[n] && before.normal[o] == now.normal[n] &&
             before.size[o] == now.size[n];
    };
    while (old < old_end && i < end) {
      if (!alike(old, i)) {
        std::uint32_t gone = 0, come = 0;
        for (std::uint32_t k = 1; k <= look_ahead && gone + come == 0; ++k)
          if (alike(old + k, i))
            gone = k;
          else if (alike(old, i + k))
            come = k;
        if (gone + come == 0) {
          ++old, ++i;  // it has moved
          continue;
        }
        old += gone, i += come;
      }
      old_of[i] = old, new_of[old] = i;
      ++old, ++i;
    }
  }
};

/// Marks the items whose stars reach as far as the item `at`.
void mark_reaching(const ItemTree& tree, std::uint32_t surface, const Vec3d& at, double farthest,
                   std::span<const float> reach, std::span<std::uint8_t> marks, std::vector<PointTree::Found>& found) {
  found.clear();
  tree.within(surface, at, farthest, found);
  for (const PointTree::Found& f : found)
    if (const double r = reach[f.point]; f.distance2 <= r * r)
      std::atomic_ref<std::uint8_t>(marks[f.point]).store(1, std::memory_order_relaxed);
}

}  // namespace

void StarFinder::take_back(std::size_t first) {
  for (std::size_t k = unsettled_.size(); k-- > first;) stars_[unsettled_[k].first] = unsettled_[k].second;
  unsettled_.resize(first);
}

void StarFinder::close() { take_back(settled_); }

/// Copies the stars that are still right; marks the others.
std::vector<std::uint8_t> StarFinder::take_over(const StarItems& items) {
  std::vector<std::uint8_t> stale(items.count(), 1);
  const Known known(items_, stars_, items);
  const std::vector<std::uint32_t> fresh =
      select_where(items.count(), [&](std::size_t i) { return known.old_of[i] == none; });
  const std::vector<std::uint32_t> gone =
      select_where(items_.count(), [&](std::size_t i) { return known.new_of[i] == none; });
  if (fresh.size() + gone.size() > items.count() / dear_share) {
    tree_.build(items);
    stars_.assign(items.count(), Star());
    return stale;
  }

  tree_.update(items, known.new_of);
  double farthest = 0;
  std::vector<float> reach(items.count(), -1);
  for (std::uint32_t i = 0; i < items.count(); ++i) {
    const std::uint32_t old = known.old_of[i];
    stale[i] = old == none;
    if (old != none) reach[i] = stars_[old].reach, farthest = std::max(farthest, double(reach[i]));
  }
  const auto around = [&](std::size_t count, const auto& mark) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
      std::vector<PointTree::Found> found;
      for (std::size_t k = range.begin(); k != range.end(); ++k) mark(k, found);
    });
  };
  around(fresh.size(), [&](std::size_t k, auto& found) {
    const std::uint32_t i = fresh[k];
    mark_reaching(tree_, items.surface[i], items.position[i], farthest, reach, stale, found);
  });
  around(gone.size(), [&](std::size_t k, auto& found) {
    const std::uint32_t old = gone[k];
    const auto at =
        std::lower_bound(items.materials.begin(), items.materials.end(), items_.materials[items_.surface[old]]);
    if (at != items.materials.end() && *at == items_.materials[items_.surface[old]])
      mark_reaching(tree_, std::uint32_t(at - items.materials.begin()), items_.position[old], farthest, reach, stale,
                    found);
  });

  std::vector<Star>& stars = spare_;  // its memory is used again
  stars.resize(items.count());
  tbb::parallel_for(std::size_t(0), items.count(), [&](std::size_t i) {
    if (stale[i]) return;
    Star& star = stars[i] = stars_[known.old_of[i]];
    for (int k = 0; k < star.count; ++k) {
      std::uint32_t& r = star.ring[std::size_t(k)];
      r = known.new_of[r];
      if (r == none) stale[i] = 1;
    }
  });
  stars_.swap(stars);
  return stale;
}

void StarFinder::find(StarItems items) {
  take_back(0);
  const std::vector<std::uint8_t> stale = take_over(items);
  cut_ = std::count(stale.begin(), stale.end(), 1);
  items_ = std::move(items);
  cut_stars(items_, tree_, stale, stars_);
  // What a star agrees on with its neighbours is the same unless one of them has changed.
  const auto has_changed = [&](std::size_t i) {
    const Star& star = stars_[i];
    return stale[i] || std::any_of(star.ring.begin(), star.ring.begin() + star.count,
                                   [&](std::uint32_t r) { return stale[r] != 0; });
  };
  std::vector<std::uint32_t> open = select_where(
      stars_.size(),
      [&](std::size_t i) {
        if (has_changed(i)) stars_[i].agreed = agreed_on(stars_, std::uint32_t(i), stars_[i]);
        return has_open(stars_[i]);
      },
      2048);
  unsettled_ = settle_stars(items_, stars_, std::move(open));
  settled_ = unsettled_.size();
}

std::vector<std::uint32_t> StarFinder::open(std::span<const std::uint32_t> some) {
  std::vector<std::uint32_t> changed;
  const auto forget = [&](std::uint32_t item, std::uint32_t from, std::uint32_t to) {
    Star& star = stars_[item];
    for (int k = 0; k < star.count; ++k) {
      if (star.ring[std::size_t(k)] != from || star.ring[std::size_t(star.after(k))] != to) continue;
      if (!(star.agreed >> k & 1)) continue;
      unsettled_.push_back({item, star});
      changed.push_back(item);
      star.agreed &= ~(1u << k);
    }
  };
  for (const std::uint32_t i : some) {
    const Star star = stars_[i];
    for (int k = 0; k < star.count; ++k) {
      if (!(star.agreed >> k & 1)) continue;
      const std::uint32_t a = star.ring[std::size_t(k)], b = star.ring[std::size_t(star.after(k))];
      forget(i, a, b), forget(a, b, i), forget(b, i, a);
    }
  }
  return changed;
}

}  // namespace nacre
