// Nacre: the stars of items, of which only those are found again whose surroundings have changed.
#include "compute/meshing/star_finder.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr std::size_t dear_share = 4;     // where more than this part has changed, finding all again costs less
constexpr std::uint32_t look_ahead = 16;  // items that may have gone or come next to each other in the order

std::uint32_t follow(const std::vector<std::uint32_t>& to, std::uint32_t i) { return i == none ? none : to[i]; }

/// Which items of `now` were there before, alike in all that a star reads of its own item, and in the same order.
class KnownItems {
 public:
  KnownItems(const StarItems& before, const std::vector<Star>& stars, const StarItems& now)
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

  std::vector<std::uint32_t> old_of, new_of;

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

/// None where so much has changed that finding all again costs less.
std::optional<ItemChange> change_of(const StarItems& before, const std::vector<Star>& stars, const StarItems& now) {
  KnownItems known(before, stars, now);
  const auto unknown = [](const std::vector<std::uint32_t>& number) {
    return select_where(number.size(), [&](std::size_t i) { return number[i] == none; });
  };
  const std::vector<std::uint32_t> fresh = unknown(known.old_of), gone = unknown(known.new_of);
  if (fresh.size() + gone.size() > now.count() / dear_share) return std::nullopt;
  ItemChange change{std::move(known.old_of), std::move(known.new_of), {}};
  for (const std::uint32_t i : fresh) change.positions.push_back({now.position[i], now.surface[i]});
  for (const std::uint32_t old : gone) {
    const auto& pair = before.materials[before.surface[old]];
    const auto at = std::lower_bound(now.materials.begin(), now.materials.end(), pair);
    if (at != now.materials.end() && *at == pair)
      change.positions.push_back({before.position[old], std::uint32_t(at - now.materials.begin())});
  }
  return change;
}

}  // namespace

void StarFinder::find(const StarParticles& particles) {
  opened_.clear();
  device_.find(
      particles, [&](const StarItems& now) { return change_of(found_.items, found_.stars, now); }, found_);
}

std::vector<std::uint32_t> StarFinder::open(std::span<const std::uint32_t> some) {
  std::vector<std::uint32_t> changed;
  const auto forget = [&](std::uint32_t item, std::uint32_t from, std::uint32_t to) {
    Star& star = found_.stars[item];
    for (int k = 0; k < star.count; ++k) {
      if (star.ring[k] != from || star.ring[star.after(k)] != to) continue;
      if (!(star.agreed >> k & 1)) continue;
      opened_.push_back({item, star.agreed});
      changed.push_back(item);
      star.agreed &= ~(1u << k);
    }
  };
  for (const std::uint32_t i : some) {
    const Star star = found_.stars[i];
    for (int k = 0; k < star.count; ++k) {
      if (!(star.agreed >> k & 1)) continue;
      const std::uint32_t a = star.ring[k], b = star.ring[star.after(k)];
      forget(i, a, b), forget(a, b, i), forget(b, i, a);
    }
  }
  return changed;
}

void StarFinder::close() {
  for (; !opened_.empty(); opened_.pop_back()) found_.stars[opened_.back().first].agreed = opened_.back().second;
}

}  // namespace nacre
