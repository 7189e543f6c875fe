// Nacre: which items were there at the call before, found on a device.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/math/bisection.hpp"
#include "compute/math/point_hash.hpp"
#include "compute/meshing/list_items.hpp"
#include "compute/meshing/list_where.hpp"

namespace nacre {

/// Which of the items that there are now were there at the call before, alike in all that a star reads of its own item.
/// In temporary memory.
struct ItemChange {
  Array<std::uint32_t> old_of;       ///< per item: its number before, or `none`
  Array<std::uint32_t> new_of;       ///< per item before: its number now, or `none`
  Array<std::uint32_t> come, gone;   ///< numbers of items that have none before, and of those before that have none now
  Array<std::uint32_t> new_surface;  ///< per surface before: its number now, or `none`
};

namespace detail {

constexpr int anchor_bits = 6;               // one in 64 items is an anchor,
constexpr std::uint32_t look_ahead = 16;     // items that may have gone or come next to each other in the order
constexpr std::uint32_t walk_patience = 96;  // items that have moved, one after the other, before a walk ends

/// Items before and now.
struct TwoLists {
  StarItemsView before, now;
  const std::uint32_t* old_surface;  // per surface now: its number before, or none

  NACRE_HD bool alike(std::uint32_t old, std::uint32_t i) const {
    return before.position[old] == now.position[i] && before.normal[old] == now.normal[i] &&
           before.size[old] == now.size[i];
  }
};

/// Few items, chosen by their positions alone: they are the same in both lists.
struct IsAnchor {
  const Vec3d* position;
  NACRE_HD bool operator()(std::int64_t i) const { return hash_point(0, position[i]) >> (64 - anchor_bits) == 0; }
};

/// The hash of an item's position in the upper half of its key, its number in the lower one.
struct KeyAnchors {
  const Vec3d* position;
  const std::uint32_t* anchor;
  std::uint64_t* key;
  NACRE_HD static std::uint64_t upper_half(const Vec3d& p) { return hash_point(0, p) << anchor_bits >> 32 << 32; }
  NACRE_HD void operator()(std::int64_t k) const { key[k] = upper_half(position[anchor[k]]) | anchor[k]; }
};

/// None where several are alike: which is which, their neighbours in the order tell.
struct MatchAnchors {
  TwoLists lists;
  const std::uint64_t* key;  // of the anchors before, ascending
  std::uint32_t keys;
  const std::uint32_t* anchor;
  std::uint32_t* match;  // per anchor: its number before, or none
  NACRE_HD void operator()(std::int64_t k) const {
    match[k] = none;
    const std::uint32_t i = anchor[k], s = lists.old_surface[lists.now.surface[i]];
    if (s == none) return;
    const std::uint64_t wanted = KeyAnchors::upper_half(lists.now.position[i]);
    for (std::uint32_t at = first_not_below(key, 0u, keys, wanted); at < keys && key[at] >> 32 == wanted >> 32; ++at) {
      const auto old = std::uint32_t(key[at]);
      if (lists.before.surface[old] != s || !lists.alike(old, i)) continue;
      const bool first = match[k] == none;
      match[k] = first ? old : none;
      if (!first) return;
    }
  }
};

/// Through both lists of one surface, side by side: from each anchor that is known to the next such, and from where the
/// surface begins.
struct WalkItems {
  TwoLists lists;
  const std::uint32_t* anchor;
  const std::uint32_t* match;
  std::uint32_t anchors;
  std::uint32_t* old_of;
  NACRE_HD void operator()(std::int64_t k) const {
    if (k < anchors) {
      if (match[k] != none) walk(lists.now.surface[anchor[k]], match[k], anchor[k], std::uint32_t(k) + 1);
      return;
    }
    const auto s = std::uint32_t(k - anchors);
    if (lists.old_surface[s] == none) return;
    const std::uint32_t i = lists.now.first[s];
    walk(s, lists.before.first[lists.old_surface[s]], i, first_not_below(anchor, 0u, anchors, i));
  }

 private:
  /// `next`: where the search for the next anchor that is known begins.
  NACRE_HD void walk(std::uint32_t s, std::uint32_t old, std::uint32_t i, std::uint32_t next) const {
    const std::uint32_t old_end = lists.before.first[lists.old_surface[s] + 1];
    std::uint32_t end = lists.now.first[s + 1];
    for (; next < anchors && anchor[next] < end; ++next)
      if (match[next] != none) end = anchor[next];
    const auto alike = [&](std::uint32_t o, std::uint32_t n) { return o < old_end && n < end && lists.alike(o, n); };
    for (std::uint32_t moved = 0; old < old_end && i < end && moved < walk_patience; ++old, ++i) {
      if (!alike(old, i)) {
        std::uint32_t gone = 0, come = 0;
        for (std::uint32_t k = 1; k <= look_ahead && gone + come == 0; ++k)
          if (alike(old + k, i))
            gone = k;
          else if (alike(old, i + k))
            come = k;
        if (gone + come == 0) {
          ++moved;
          continue;
        }
        old += gone, i += come;
      }
      old_of[i] = old;
      moved = 0;
    }
  }
};

/// Of several items that found the same one, the first is the one that was there before.
struct NumberKnown {
  const std::uint32_t* old_of;
  std::uint32_t* new_of;
  NACRE_HD void operator()(std::int64_t i) const {
    if (old_of[i] != none) atomic_min(new_of + old_of[i], std::uint32_t(i));
  }
};

/// Which of two in one place is left out depends on more than the place: it is not known again.
struct ForgetTwins {
  const Star* before;
  std::uint32_t* old_of;
  std::uint32_t* new_of;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t old = old_of[i];
    if (old == none) return;
    const bool first = relaxed_load(new_of + old) == std::uint32_t(i);
    if (first && !before[old].hidden) return;
    old_of[i] = none;
    if (first) relaxed_store(new_of + old, none);
  }
};

/// Marks items that have others beside them on a rim than before.
struct MarkOtherRims {
  TwoLists lists;
  const std::uint32_t* old_of;
  const std::uint32_t* new_of;
  std::uint32_t* mark;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t old = old_of[i];
    mark[i] = old != none && (differ(lists.before.next[old], lists.now.next[i]) ||
                              differ(lists.before.previous[old], lists.now.previous[i]));
  }

 private:
  NACRE_HD bool differ(std::uint32_t old, std::uint32_t now) const {
    return old == none ? now != none : now == none || new_of[old] != now;
  }
};

struct ForgetMarked {
  const std::uint32_t* mark;
  std::uint32_t* old_of;
  std::uint32_t* new_of;
  NACRE_HD void operator()(std::int64_t i) const {
    if (mark[i]) new_of[old_of[i]] = none, old_of[i] = none;
  }
};

struct HasNone {
  const std::uint32_t* number;
  NACRE_HD bool operator()(std::int64_t i) const { return number[i] == none; }
};

/// Numbers in `to` of the surfaces of `from`, or `none`.
inline std::vector<std::uint32_t> same_surfaces(const DeviceItems& from, const DeviceItems& to) {
  std::vector<std::uint32_t> same;
  for (const MaterialPair& pair : from.materials()) {
    const auto at = std::lower_bound(to.materials().begin(), to.materials().end(), pair);
    const bool there = at != to.materials().end() && *at == pair;
    same.push_back(there ? std::uint32_t(at - to.materials().begin()) : none);
  }
  return same;
}

}  // namespace detail

/// What has changed from the items `before`, which had these stars, to those `now`; at least one of each. Items are
/// known again where they come in the same order, as most do where a few particles move, go or come. The answer does
/// not depend on the order that threads come in. Memory is temporary, of the caller's scope.
template <class Backend>
ItemChange item_change(Executor<Backend>& exec, const DeviceItems& before, const Star* stars, const DeviceItems& now) {
  Arena& arena = exec.arena();
  const auto list = [&](std::size_t size) { return arena.template temporary<std::uint32_t>(size); };
  const auto copied = [&](const std::vector<std::uint32_t>& host) {
    auto array = list(host.size());
    array.upload(host);
    return array;
  };
  const auto n = std::int64_t(now.count()), n_before = std::int64_t(before.count());
  ItemChange change;
  change.new_surface = copied(detail::same_surfaces(before, now));
  change.old_of = list(now.count()), change.new_of = list(before.count());
  exec.fill(change.old_of, 0xff), exec.fill(change.new_of, 0xff);
  {
    Arena::Scope scope(arena);
    const detail::TwoLists lists{before.view(copied(before.first()).data()), now.view(copied(now.first()).data()),
                                 copied(detail::same_surfaces(now, before)).data()};
    const auto old_anchor = list_where(exec, n_before, detail::IsAnchor{lists.before.position});
    const auto anchor = list_where(exec, n, detail::IsAnchor{lists.now.position});
    const auto key = arena.template temporary<std::uint64_t>(old_anchor.size());
    exec.for_each(std::int64_t(key.size()), detail::KeyAnchors{lists.before.position, old_anchor.data(), key.data()});
    exec.sort(key.data(), std::int64_t(key.size()), 32);
    const auto match = list(anchor.size());
    const auto anchors = std::uint32_t(anchor.size());
    exec.for_each(anchors,
                  detail::MatchAnchors{lists, key.data(), std::uint32_t(key.size()), anchor.data(), match.data()});
    exec.for_each(std::int64_t(anchors + now.materials().size()),
                  detail::WalkItems{lists, anchor.data(), match.data(), anchors, change.old_of.data()});
    exec.for_each(n, detail::NumberKnown{change.old_of.data(), change.new_of.data()});
    exec.for_each(n, detail::ForgetTwins{stars, change.old_of.data(), change.new_of.data()});
    const auto mark = list(now.count());
    exec.for_each(n, detail::MarkOtherRims{lists, change.old_of.data(), change.new_of.data(), mark.data()});
    exec.for_each(n, detail::ForgetMarked{mark.data(), change.old_of.data(), change.new_of.data()});
  }
  change.come = list_where(exec, n, detail::HasNone{change.old_of.data()});
  change.gone = list_where(exec, n_before, detail::HasNone{change.new_of.data()});
  return change;
}

}  // namespace nacre
