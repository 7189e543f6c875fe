// Nacre: which of many numbers meet a condition.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

/// The numbers i < count for which test(i) is true, ascending. In parallel, `part` numbers at a time: fewer where a
/// test is costly. `test` may change what belongs to i alone.
template <class Test>
std::vector<std::uint32_t> select_where(std::size_t count, const Test& test, std::size_t part = 1 << 13) {
  std::vector<std::vector<std::uint32_t>> found((count + part - 1) / part);
  tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t k) {
    for (std::size_t i = k * part; i < std::min(count, (k + 1) * part); ++i)
      if (test(i)) found[k].push_back(std::uint32_t(i));
  });
  std::vector<std::uint32_t> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// The numbers that are marked, ascending.
inline std::vector<std::uint32_t> marked(std::span<const std::uint8_t> marks) {
  return select_where(marks.size(), [&](std::size_t i) { return marks[i] != 0; });
}

}  // namespace nacre
