// Nacre: lists of the items of each bin, as sorted keys: bin << 32 | item.
#pragma once

#include <cstdint>
#include <string>

#include "compute/device/executor.hpp"

namespace nacre {

namespace detail {

/// Counts the bins of an item if `keys` is null, otherwise writes them. It is one kernel for both, because a compiler
/// may round two instantiations of the same geometry differently. An item with one bin only is not processed twice.
template <class Enumerate>
struct EnumerateKeys {
  Enumerate enumerate;
  std::uint64_t items, pairs;
  std::uint64_t* count;  // later: where the item's keys begin
  std::uint32_t* first;  // the item's first bin
  std::uint64_t* keys;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t at = keys ? count[i] : 0;
    if (keys) {
      const std::uint64_t end = std::uint64_t(i) + 1 < items ? count[i + 1] : pairs;
      if (end == at) return;
      keys[at] = std::uint64_t(first[i]) << 32 | std::uint64_t(i);
      if (end == at + 1) return;
    }
    enumerate(i, [&](std::uint64_t bin) {
      if (keys)
        keys[at] = bin << 32 | std::uint64_t(i);
      else if (at == 0)
        first[i] = std::uint32_t(bin);
      ++at;
    });
    if (!keys) count[i] = at;
  }
};

struct HeadFlag {
  const std::uint64_t* keys;
  std::uint32_t* head;
  NACRE_HD void operator()(std::int64_t i) const { head[i] = i == 0 || keys[i] >> 32 != keys[i - 1] >> 32 ? 1 : 0; }
};

/// First index whose key has a bin of at least i: the lists of all bins as offsets.
template <class Offset>
struct ListStart {
  std::uint64_t pairs;
  const std::uint64_t* keys;
  Offset* start;
  NACRE_HD void operator()(std::int64_t bin) const {
    std::uint64_t low = 0, high = pairs;
    while (low < high) {
      const std::uint64_t middle = (low + high) / 2;
      if (keys[middle] >> 32 < std::uint64_t(bin))
        low = middle + 1;
      else
        high = middle;
    }
    start[bin] = Offset(low);
  }
};

struct LowHalf {
  const std::uint64_t* keys;
  std::uint32_t* value;
  NACRE_HD void operator()(std::int64_t i) const { value[i] = std::uint32_t(keys[i]); }
};

}  // namespace detail

/// `enumerate(i, visit)` calls visit(bin) for every 32-bit bin of item i (it runs twice). Returns all
/// (bin, item) pairs in ascending order, counted in 64 bits, in temporary memory of the caller's scope.
template <class Backend, class Enumerate>
Array<std::uint64_t> sorted_pairs(Executor<Backend>& exec, std::int64_t items, const Enumerate& enumerate) {
  Arena& arena = exec.arena();
  Array<std::uint64_t> start = arena.temporary<std::uint64_t>(items);
  Array<std::uint32_t> first = arena.temporary<std::uint32_t>(items);
  const auto n = std::uint64_t(items);
  exec.for_each(items, detail::EnumerateKeys<Enumerate>{enumerate, n, 0, start.data(), first.data(), nullptr});
  const std::uint64_t total = exec.exclusive_scan(start.data(), start.data(), items);
  Array<std::uint64_t> keys = arena.temporary<std::uint64_t>(total);
  exec.for_each(items, detail::EnumerateKeys<Enumerate>{enumerate, n, total, start.data(), first.data(), keys.data()});
  exec.sort(keys.data(), total, 32);  // items ascend already
  return keys;
}

/// For sorted keys: `number[i]` = how many different bins begin before key i (the number of the bin of key i is
/// that, plus its own head flag, minus one). Returns how many bins there are.
template <class Backend>
std::uint32_t number_bins(Executor<Backend>& exec, const Array<std::uint64_t>& keys, Array<std::uint32_t>& number) {
  const std::int64_t n = keys.size();
  number = exec.arena().template temporary<std::uint32_t>(n);
  exec.for_each(n, detail::HeadFlag{keys.data(), number.data()});
  return exec.exclusive_scan(number.data(), number.data(), n);
}

}  // namespace nacre
