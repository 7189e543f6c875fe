// Nacre: lists of which item lies where, as sorted keys: (place << 32 | item).
#pragma once

#include <cstdint>
#include <string>

#include "compute/device/executor.hpp"

namespace nacre {

namespace detail {

template <class Enumerate>
struct CountKeys {
  Enumerate enumerate;
  std::uint64_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t n = 0;
    enumerate(i, [&](std::uint32_t) { ++n; });
    count[i] = n;
  }
};

template <class Enumerate>
struct WriteKeys {
  Enumerate enumerate;
  const std::uint64_t* start;
  std::uint64_t* keys;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t* to = keys + start[i];
    enumerate(i, [&](std::uint32_t place) { *to++ = std::uint64_t(place) << 32 | std::uint64_t(i); });
  }
};

struct HeadFlag {
  const std::uint64_t* keys;
  std::uint32_t* head;
  NACRE_HD void operator()(std::int64_t i) const { head[i] = i == 0 || keys[i] >> 32 != keys[i - 1] >> 32 ? 1 : 0; }
};

}  // namespace detail

/// `enumerate(i, visit)` calls visit(place) for every place of item i (deterministically: it runs twice). Returns all
/// (place, item) pairs in ascending order, counted in 64 bits, in temporary memory of the caller's scope.
template <class Backend, class Enumerate>
Array<std::uint64_t> sorted_pairs(Executor<Backend>& exec, std::int64_t items, const Enumerate& enumerate) {
  Arena& arena = exec.arena();
  Array<std::uint64_t> start = arena.temporary<std::uint64_t>(items);
  exec.for_each(items, detail::CountKeys<Enumerate>{enumerate, start.data()});
  const std::uint64_t total = exec.exclusive_scan(start.data(), start.data(), items);
  Array<std::uint64_t> keys = arena.temporary<std::uint64_t>(total);
  exec.for_each(items, detail::WriteKeys<Enumerate>{enumerate, start.data(), keys.data()});
  exec.sort(keys.data(), total);
  return keys;
}

/// For sorted keys: `number[i]` = how many different places begin before key i (the number of key i's place is that,
/// plus its own head flag, minus one). Returns how many places there are.
template <class Backend>
std::uint32_t number_places(Executor<Backend>& exec, const Array<std::uint64_t>& keys, Array<std::uint32_t>& number) {
  const std::int64_t n = keys.size();
  number = exec.arena().template temporary<std::uint32_t>(n);
  exec.for_each(n, detail::HeadFlag{keys.data(), number.data()});
  return exec.exclusive_scan(number.data(), number.data(), n);
}

}  // namespace nacre
