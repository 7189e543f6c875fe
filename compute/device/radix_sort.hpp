// Nacre: sorting integer keys on the CPU, digit by digit from the lowest, stable and on all workers.
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace nacre::detail {

/// Keys that move alone.
struct KeysAlone {
  std::uint64_t* key;
  void move(std::int64_t from, const KeysAlone& other, std::int64_t to) const { other.key[to] = key[from]; }
};

/// Keys and the values that go with them.
struct KeysWithValues {
  std::uint64_t* key;
  std::uint32_t* value;
  void move(std::int64_t from, const KeysWithValues& other, std::int64_t to) const {
    other.key[to] = key[from];
    other.value[to] = value[from];
  }
};

/// Bits in which some of the keys differ.
inline std::uint64_t differing_bits(const std::uint64_t* key, std::int64_t n) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::int64_t>(0, n, 1 << 14), std::uint64_t(0),
      [&](const tbb::blocked_range<std::int64_t>& range, std::uint64_t bits) {
        for (std::int64_t i = range.begin(); i < range.end(); ++i) bits |= key[i] ^ key[0];
        return bits;
      },
      [](std::uint64_t a, std::uint64_t b) { return a | b; });
}

/// Sorts `n` > 0 items of `data` by the bits of their keys from `lowest` up; equal ones stay in their order. `other` is
/// scratch of the same size. Digits in which all keys agree cost nothing.
template <class Data>
void radix_sort(Data data, Data other, std::int64_t n, int lowest = 0) {
  constexpr int digit_bits = 8, digits = 1 << digit_bits;
  const Data home = data;
  const std::int64_t blocks = std::clamp<std::int64_t>(n >> 14, 1, 256);
  std::vector<std::int64_t> offset(blocks * digits);
  auto each_block = [&](const auto& body) {
    tbb::parallel_for(std::int64_t(0), blocks,
                      [&](std::int64_t b) { body(offset.data() + b * digits, n * b / blocks, n * (b + 1) / blocks); });
  };
  std::uint64_t left = differing_bits(data.key, n) >> lowest << lowest;
  while (left) {
    const int shift = __builtin_ctzll(left);
    left &= ~(std::uint64_t(digits - 1) << shift);
    auto digit = [&](std::int64_t i) { return data.key[i] >> shift & (digits - 1); };
    std::fill(offset.begin(), offset.end(), 0);
    each_block([&](std::int64_t* count, std::int64_t first, std::int64_t last) {
      for (std::int64_t i = first; i < last; ++i) ++count[digit(i)];
    });
    std::int64_t at = 0;
    for (int d = 0; d < digits; ++d)
      for (std::int64_t b = 0; b < blocks; ++b) at += std::exchange(offset[b * digits + d], at);
    each_block([&](std::int64_t* to, std::int64_t first, std::int64_t last) {
      for (std::int64_t i = first; i < last; ++i) data.move(i, other, to[digit(i)]++);
    });
    std::swap(data, other);
  }
  if (data.key == home.key) return;
  each_block([&](std::int64_t*, std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) data.move(i, other, i);
  });
}

}  // namespace nacre::detail
