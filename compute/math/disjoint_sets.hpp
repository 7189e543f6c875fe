// Nacre: sets that are joined.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace nacre {

/// Sets of the numbers from 0 on, one each at first; each is known by its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t members) : parent_(members) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Returns the member by which the joined set is known.
  std::uint32_t join(std::uint32_t i, std::uint32_t j) {
    i = find(i), j = find(j);
    return parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace nacre
