// Nacre: lists of the items of each 64-bit code, as of a brick; only codes with items have a list.
#pragma once

#include <cstdint>

#include "compute/device/error.hpp"
#include "compute/device/executor.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

/// Runs of equal codes among sorted ones: `code` ascends; run k is start[k] .. start[k + 1] - 1.
struct CodeRuns {
  std::uint32_t count = 0;
  Array<std::uint64_t> code;
  Array<std::uint64_t> start;  ///< count + 1 entries
};

/// The items of the code of run k are item[runs.start[k]] .. item[runs.start[k + 1] - 1], ascending.
struct CodeLists {
  CodeRuns runs;
  Array<std::uint32_t> item;
};

namespace detail {

/// Counts the codes of an item if `written` is null, otherwise writes them. It is one kernel for both, because a
/// compiler may round two instantiations of the same geometry differently. The first codes of an item are stored when
/// they are counted, so that only an item with more is processed twice.
template <class Enumerate>
struct EnumerateCodes {
  static constexpr int kept = 4;
  Enumerate enumerate;
  std::uint64_t items, pairs;
  std::uint64_t* count;  // later: where the item's codes begin
  std::uint64_t* first;  // `kept` per item
  std::uint64_t* written;
  std::uint32_t* item;

  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t at = written ? count[i] : 0;
    if (written) {
      const std::uint64_t end = std::uint64_t(i) + 1 < items ? count[i + 1] : pairs;
      if (end - at <= kept) {
        for (std::uint64_t k = at; k < end; ++k) written[k] = first[kept * i + (k - at)], item[k] = std::uint32_t(i);
        return;
      }
    }
    enumerate(i, [&](std::uint64_t code) {
      if (written)
        written[at] = code, item[at] = std::uint32_t(i);
      else if (at < kept)
        first[kept * i + at] = code;
      ++at;
    });
    if (!written) count[i] = at;
  }
};

/// Whether a run begins at code i; the lowest `shift` bits of codes do not count.
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
  std::uint64_t* run_code;
  std::uint64_t* start;
  NACRE_HD void operator()(std::int64_t i) const {
    if (head(i)) {
      run_code[number[i]] = head.code[i] >> head.shift;
      start[number[i]] = std::uint64_t(i);
    }
    if (std::uint64_t(i) + 1 == codes) start[runs] = codes;
  }
};

}  // namespace detail

/// The runs among `n` sorted codes, without their lowest `shift` bits; 16 bytes a run in temporary memory of the
/// caller's scope.
template <class Backend>
CodeRuns runs_of(Executor<Backend>& exec, const std::uint64_t* code, std::uint64_t n, int shift) {
  Arena& arena = exec.arena();
  CodeRuns runs;
  if (n == 0) return runs;
  const detail::RunHead head{code, shift};
  const std::uint64_t count = exec.reduce(std::int64_t(n), std::uint64_t(0), head, Add{});
  if (count >= none) throw Error("the grid is too fine", "over 2^32 bricks", "lower the resolution");
  runs.count = std::uint32_t(count);
  runs.code = arena.temporary<std::uint64_t>(count);
  runs.start = arena.temporary<std::uint64_t>(count + 1);
  Arena::Scope scope(arena);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(n);
  exec.for_each(std::int64_t(n), detail::FlagRunHead{head, number.data()});
  exec.exclusive_scan(number.data(), number.data(), std::int64_t(n));
  exec.for_each(std::int64_t(n),
                detail::WriteRun{head, n, runs.count, number.data(), runs.code.data(), runs.start.data()});
  return runs;
}

/// `enumerate(i, visit)` calls visit(code) for every code of item i, at most once each. The lists are temporary in the
/// caller's scope: 12 bytes per pair, 16 per code and 40 per item. Throws Error if they do not fit.
template <class Backend, class Enumerate>
CodeLists code_lists(Executor<Backend>& exec, std::int64_t items, const Enumerate& enumerate) {
  Arena& arena = exec.arena();
  CodeLists lists;
  const auto n = std::uint64_t(items);
  using Codes = detail::EnumerateCodes<Enumerate>;
  Array<std::uint64_t> count = arena.temporary<std::uint64_t>(items);
  Array<std::uint64_t> first = arena.temporary<std::uint64_t>(Codes::kept * n);
  exec.for_each(items, Codes{enumerate, n, 0, count.data(), first.data(), nullptr, nullptr});
  const std::uint64_t pairs = exec.exclusive_scan(count.data(), count.data(), items);
  lists.item = arena.temporary<std::uint32_t>(pairs);
  Array<std::uint64_t> code = arena.temporary<std::uint64_t>(pairs);
  exec.for_each(items, Codes{enumerate, n, pairs, count.data(), first.data(), code.data(), lists.item.data()});
  exec.sort_pairs(code.data(), lists.item.data(), std::int64_t(pairs));
  lists.runs = runs_of(exec, code.data(), pairs, 0);
  return lists;
}

}  // namespace nacre
