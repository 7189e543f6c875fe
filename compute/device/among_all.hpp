// Nacre: what processes find out together: extremes, exact sums, and lists of small records that they send each other.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "compute/device/exact_sum.hpp"
#include "compute/device/ranks.hpp"

namespace nacre {

/// A list for each process.
template <class Item>
using ForEachRank = std::vector<std::vector<Item>>;

template <class Item>
ForEachRank<Item> for_each_rank(const Ranks& ranks) {
  return ForEachRank<Item>(static_cast<std::size_t>(ranks.count()));
}

/// Sends `send[q]` to process q, for all q, and empties it; returns what came from each. Collective, as all that
/// follow.
template <class Item>
ForEachRank<Item> exchange_items(Ranks& ranks, ForEachRank<Item>& send) {
  static_assert(std::is_trivially_copyable_v<Item>);
  std::vector<Ranks::Bytes> bytes;
  for (std::vector<Item>& items : send) {
    Ranks::Bytes& to = bytes.emplace_back(items.size() * sizeof(Item));
    if (!items.empty()) std::memcpy(to.data(), items.data(), to.size());
    std::vector<Item>().swap(items);
  }
  ForEachRank<Item> received;
  for (Ranks::Bytes& from : ranks.exchange(bytes)) {
    std::vector<Item>& items = received.emplace_back(from.size() / sizeof(Item));
    if (!items.empty()) std::memcpy(items.data(), from.data(), items.size() * sizeof(Item));
    Ranks::Bytes().swap(from);
  }
  return received;
}

/// The value of each process, in their order; `ranks` null: this one alone.
inline std::vector<std::uint64_t> values_of_all(Ranks* ranks, std::uint64_t value) {
  if (!ranks) return {value};
  std::vector<std::uint64_t> all(static_cast<std::size_t>(ranks->count()));
  all[static_cast<std::size_t>(ranks->rank())] = value;
  ranks->sum(all);
  return all;
}

inline std::uint64_t sum_of_all(Ranks* ranks, std::uint64_t value) {
  if (ranks) ranks->sum({&value, 1});
  return value;
}

inline void sum_of_all(Ranks* ranks, ExactSum& sum) {
  if (ranks) ranks->sum(sum.raw());
}

/// Replaces each value by the least, or the largest, that a process has in its place. No value is NaN.
inline void extremes_of_all(Ranks* ranks, std::span<double> least, std::span<double> largest) {
  if (!ranks) return;
  const std::size_t n = least.size() + largest.size(), own = static_cast<std::size_t>(ranks->rank()) * n;
  std::vector<std::uint64_t> all(n * static_cast<std::size_t>(ranks->count()));
  for (std::size_t k = 0; k < n; ++k)
    all[own + k] = std::bit_cast<std::uint64_t>(k < least.size() ? least[k] : largest[k - least.size()]);
  ranks->sum(all);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::size_t i = k % n;
    const auto value = std::bit_cast<double>(all[k]);
    if (i < least.size())
      least[i] = std::min(least[i], value);
    else
      largest[i - least.size()] = std::max(largest[i - least.size()], value);
  }
}

}  // namespace nacre
