// Nacre: lists of the items at each place, where places are 64-bit codes; only places with items have a list.
#pragma once

#include <cstdint>

#include "compute/device/error.hpp"
#include "compute/device/executor.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

/// Runs of equal places among sorted codes: `position` ascends; run k is codes start[k] .. start[k + 1] - 1.
struct CodeRuns {
  std::uint32_t count = 0;
  Array<std::uint64_t> position;
  Array<std::uint64_t> start;  ///< count + 1 entries
};

/// Places that have items; the items of place k are item[places.start[k]] .. item[places.start[k + 1] - 1], ascending.
struct PlaceLists {
  CodeRuns places;
  Array<std::uint32_t> item;
};

namespace detail {

/// Counts the places of an item if `position` is null, otherwise writes them. It is one kernel for both, because a
/// compiler may round two instantiations of the same geometry differently. The first places of an item are stored when
/// they are counted, so that only an item with more is processed twice.
template <class Enumerate>
struct EnumeratePlaces {
  static constexpr int kept = 4;
  Enumerate enumerate;
  std::uint64_t items, pairs;
  std::uint64_t* count;  // later: where the item's places begin
  std::uint64_t* first;  // `kept` per item
  std::uint64_t* position;
  std::uint32_t* item;

  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t at = position ? count[i] : 0;
    if (position) {
      const std::uint64_t end = std::uint64_t(i) + 1 < items ? count[i + 1] : pairs;
      if (end - at <= kept) {
        for (std::uint64_t k = at; k < end; ++k) position[k] = first[kept * i + (k - at)], item[k] = std::uint32_t(i);
        return;
      }
    }
    enumerate(i, [&](std::uint64_t code) {
      if (position)
        position[at] = code, item[at] = std::uint32_t(i);
      else if (at < kept)
        first[kept * i + at] = code;
      ++at;
    });
    if (!position) count[i] = at;
  }
};

/// Whether a new place begins at code i; places are codes without their lowest `shift` bits.
struct RunHead {
  const std::uint64_t* code;
  int shift;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const {
    return i == 0 || code[i] >> shift != code[i - 1] >> shift ? 1 : 0;
  }
};

struct FlagRunHead {
  RunHead head;
  std::uint32_t* flag;
  NACRE_HD void operator()(std::int64_t i) const { flag[i] = std::uint32_t(head(i)); }
};

struct WriteRun {
  RunHead head;
  std::uint64_t codes;
  std::uint32_t runs;
  const std::uint32_t* number;  // exclusive scan of the flags
  std::uint64_t* position;
  std::uint64_t* start;
  NACRE_HD void operator()(std::int64_t i) const {
    if (head(i)) {
      position[number[i]] = head.code[i] >> head.shift;
      start[number[i]] = std::uint64_t(i);
    }
    if (std::uint64_t(i) + 1 == codes) start[runs] = codes;
  }
};

}  // namespace detail

/// The runs among `n` sorted codes, whose places are the codes without their lowest `shift` bits; 16 bytes a run in
/// temporary memory of the caller's scope.
template <class Backend>
CodeRuns runs_of(Executor<Backend>& exec, const std::uint64_t* code, std::uint64_t n, int shift) {
  Arena& arena = exec.arena();
  CodeRuns runs;
  if (n == 0) return runs;
  const detail::RunHead head{code, shift};
  const std::uint64_t count = exec.reduce(std::int64_t(n), std::uint64_t(0), head, Add{});
  if (count >= none) throw Error("the grid is too fine", "over 2^32 bricks", "lower the resolution");
  runs.count = std::uint32_t(count);
  runs.position = arena.temporary<std::uint64_t>(count);
  runs.start = arena.temporary<std::uint64_t>(count + 1);
  Arena::Scope scope(arena);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(n);
  exec.for_each(std::int64_t(n), detail::FlagRunHead{head, number.data()});
  exec.exclusive_scan(number.data(), number.data(), std::int64_t(n));
  exec.for_each(std::int64_t(n),
                detail::WriteRun{head, n, runs.count, number.data(), runs.position.data(), runs.start.data()});
  return runs;
}

/// `enumerate(i, visit)` calls visit(code) for every place of item i, at most once each. The lists are temporary in the
/// caller's scope: 12 bytes per pair, 16 per place and 40 per item. Throws Error if they do not fit.
template <class Backend, class Enumerate>
PlaceLists place_lists(Executor<Backend>& exec, std::int64_t items, const Enumerate& enumerate) {
  Arena& arena = exec.arena();
  PlaceLists lists;
  const auto n = std::uint64_t(items);
  using Places = detail::EnumeratePlaces<Enumerate>;
  Array<std::uint64_t> count = arena.temporary<std::uint64_t>(items);
  Array<std::uint64_t> first = arena.temporary<std::uint64_t>(Places::kept * n);
  exec.for_each(items, Places{enumerate, n, 0, count.data(), first.data(), nullptr, nullptr});
  const std::uint64_t pairs = exec.exclusive_scan(count.data(), count.data(), items);
  lists.item = arena.temporary<std::uint32_t>(pairs);
  Array<std::uint64_t> code = arena.temporary<std::uint64_t>(pairs);
  exec.for_each(items, Places{enumerate, n, pairs, count.data(), first.data(), code.data(), lists.item.data()});
  exec.sort_pairs(code.data(), lists.item.data(), std::int64_t(pairs));
  lists.places = runs_of(exec, code.data(), pairs, 0);
  return lists;
}

}  // namespace nacre
