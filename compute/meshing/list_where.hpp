// Nacre: which of many numbers meet a condition, listed on a device.
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"

namespace nacre {

namespace detail {

template <class Test>
struct MarkWhere {
  Test test;
  std::uint32_t* mark;
  NACRE_HD void operator()(std::int64_t i) const { mark[i] = test(i) ? 1 : 0; }
};

/// `before` holds how many are listed before each.
struct PutMarked {
  const std::uint32_t* before;
  std::int64_t n;
  std::uint32_t listed;
  std::uint32_t* to;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t end = i + 1 < n ? before[i + 1] : listed;
    if (before[i] < end) to[before[i]] = std::uint32_t(i);
  }
};

}  // namespace detail

/// The numbers i < n for which test(i) is true, ascending, in temporary memory of the caller's scope.
template <class Backend, class Test>
Array<std::uint32_t> list_where(Executor<Backend>& exec, std::int64_t n, const Test& test) {
  const auto before = exec.arena().template temporary<std::uint32_t>(std::size_t(n));
  exec.for_each(n, detail::MarkWhere<Test>{test, before.data()});
  const std::uint32_t listed = exec.exclusive_scan(before.data(), before.data(), n);
  const auto list = exec.arena().template temporary<std::uint32_t>(listed);
  if (listed > 0) exec.for_each(n, detail::PutMarked{before.data(), n, listed, list.data()});
  return list;
}

}  // namespace nacre
