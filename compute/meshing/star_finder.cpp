// Nacre: the stars of items, of which only those are found again whose surroundings have changed.
#include "compute/meshing/star_finder.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "compute/meshing/star_settling.hpp"

namespace nacre {
namespace {

constexpr std::size_t dear_share = 4;  // where more than this part has changed, finding all again costs less

/// Items by their surface and position.
class ItemTable {
 public:
  explicit ItemTable(const StarItems& items) : items_(items), slots_(std::bit_ceil(2 * items.count() + 2), none) {
    for (std::uint32_t i = 0; i < items.count(); ++i) {
      const std::size_t slot = slot_of(pair_of(items, i), items.position[i]);
      if (slots_[slot] == none) slots_[slot] = i;
    }
  }

  static std::array<std::uint16_t, 2> pair_of(const StarItems& items, std::uint32_t i) {
    return items.materials[items.surface[i]];
  }

  /// The first item there, or `none`.
  std::uint32_t find(const std::array<std::uint16_t, 2>& pair, const Vec3d& position) const {
    return slots_[slot_of(pair, position)];
  }

 private:
  std::size_t slot_of(const std::array<std::uint16_t, 2>& pair, const Vec3d& position) const {
    std::uint64_t key = std::uint64_t(pair[0]) << 16 | pair[1];
    for (const double x : {position.x, position.y, position.z})
      key = (std::rotl(key, 21) ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u;
    std::size_t slot = (key ^ key >> 32) & (slots_.size() - 1);
    while (slots_[slot] != none &&
           !(items_.position[slots_[slot]] == position && pair_of(items_, slots_[slot]) == pair))
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  const StarItems& items_;
  std::vector<std::uint32_t> slots_;
};

std::uint32_t follow(const std::vector<std::uint32_t>& to, std::uint32_t i) { return i == none ? none : to[i]; }

/// Which items of `now` were there before, alike in all that a star reads of its own item.
struct Known {
  std::vector<std::uint32_t> old_of, new_of;

  Known(const StarItems& before, const StarItems& now) : old_of(now.count(), none), new_of(before.count(), none) {
    const ItemTable table(before);
    tbb::parallel_for(std::size_t(0), now.count(), [&](std::size_t i) {
      const std::uint32_t old = table.find(ItemTable::pair_of(now, std::uint32_t(i)), now.position[i]);
      if (old != none && before.normal[old] == now.normal[i] && before.size[old] == now.size[i]) old_of[i] = old;
    });
    for (std::uint32_t i = 0; i < now.count(); ++i)
      if (const std::uint32_t old = old_of[i]; old != none) {
        if (new_of[old] == none)
          new_of[old] = i;
        else
          old_of[i] = none;  // two in one place: the second is looked at again
      }
    std::vector<std::uint32_t> differ;
    for (std::uint32_t i = 0; i < now.count(); ++i)
      if (const std::uint32_t old = old_of[i];
          old != none &&
          (follow(new_of, before.next[old]) != now.next[i] || follow(new_of, before.previous[old]) != now.previous[i] ||
           (before.next[old] == none) != (now.next[i] == none) ||
           (before.previous[old] == none) != (now.previous[i] == none)))
        differ.push_back(i);
    for (const std::uint32_t i : differ) new_of[old_of[i]] = none, old_of[i] = none;
  }
};

}  // namespace

/// Copies the stars that are still right; marks the others.
std::vector<std::uint8_t> StarFinder::take_over(const StarItems& items, const PointTree& tree,
                                                std::vector<Star>& stars) const {
  std::vector<std::uint8_t> stale(items.count(), 1);
  if (stars_.empty()) return stale;
  const Known known(items_, items);
  const auto fresh = std::size_t(std::count(known.old_of.begin(), known.old_of.end(), none));
  const auto gone = std::size_t(std::count(known.new_of.begin(), known.new_of.end(), none));
  if (fresh + gone > items.count() / dear_share) return stale;

  double farthest = 0;
  for (const Star& star : stars_) farthest = std::max(farthest, double(star.reach));
  for (std::uint32_t i = 0; i < items.count(); ++i) stale[i] = known.old_of[i] == none;
  std::vector<PointTree::Found> found;
  const auto mark_around = [&](std::uint32_t surface, const Vec3d& position) {
    found.clear();
    tree.within(surface, position, farthest, found);
    for (const PointTree::Found& f : found) {
      const std::uint32_t old = known.old_of[f.point];
      if (old != none && f.distance2 <= double(stars_[old].reach) * stars_[old].reach) stale[f.point] = 1;
    }
  };
  for (std::uint32_t i = 0; i < items.count(); ++i)
    if (known.old_of[i] == none) mark_around(items.surface[i], items.position[i]);
  for (std::uint32_t old = 0; old < items_.count(); ++old) {
    if (known.new_of[old] != none) continue;
    const auto pair = ItemTable::pair_of(items_, old);
    const auto at = std::lower_bound(items.materials.begin(), items.materials.end(), pair);
    if (at != items.materials.end() && *at == pair)
      mark_around(std::uint32_t(at - items.materials.begin()), items_.position[old]);
  }
  tbb::parallel_for(std::size_t(0), items.count(), [&](std::size_t i) {
    if (stale[i]) return;
    Star star = stars_[known.old_of[i]];
    for (int k = 0; k < star.count; ++k) {
      std::uint32_t& r = star.ring[std::size_t(k)];
      r = known.new_of[r];
      if (r == none) stale[i] = 1;
    }
    if (!stale[i]) stars[i] = star;
  });
  return stale;
}

std::vector<Star> StarFinder::find(const StarItems& items) {
  const PointTree tree(items.position, items.first);
  std::vector<Star> stars(items.count());
  const std::vector<std::uint8_t> stale = take_over(items, tree, stars);
  cut_ = std::count(stale.begin(), stale.end(), 1);
  cut_stars(items, tree, stale, stars);
  items_ = items;
  stars_ = stars;
  tbb::parallel_for(std::size_t(0), items.count(),
                    [&](std::size_t i) { mark_agreed(stars, std::uint32_t(i), stars[i]); });
  settle_stars(items, stars);
  return stars;
}

}  // namespace nacre
