// Nacre: sets that are joined.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace nacre {

/// Sets of the numbers from 0 on, one each at first; each is known by its smallest member. Several threads may join at
/// once; the sets are the same in whatever order they do.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t members) : parent_(members) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    for (;;) {
      std::uint32_t parent = at(i).load(std::memory_order_relaxed);
      if (parent == i) return i;
      const std::uint32_t above = at(parent).load(std::memory_order_relaxed);
      if (above != parent) at(i).compare_exchange_weak(parent, above, std::memory_order_relaxed);
      i = above;
    }
  }
  /// Returns the member by which the joined set is known.
  std::uint32_t join(std::uint32_t i, std::uint32_t j) {
    for (;;) {
      i = find(i), j = find(j);
      if (i == j) return i;
      if (i < j) std::swap(i, j);
      std::uint32_t own = i;  // unless another thread has joined it meanwhile
      if (at(i).compare_exchange_strong(own, j, std::memory_order_relaxed)) return j;
    }
  }

 private:
  std::atomic_ref<std::uint32_t> at(std::uint32_t i) { return std::atomic_ref(parent_[i]); }

  std::vector<std::uint32_t> parent_;
};

}  // namespace nacre
