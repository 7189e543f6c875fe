// Nacre: counter-based random numbers: the same (seed, counter) gives the same number on every thread and backend.
#pragma once

#include <cstdint>

#include "compute/device/backend.hpp"

namespace nacre {

struct Random2 {
  std::uint32_t a, b;
};

/// Philox-2x32 with 10 rounds (Salmon et al. 2011): two independent 32-bit numbers of a 64-bit counter and a key.
NACRE_HD constexpr Random2 philox(std::uint32_t counter_low, std::uint32_t counter_high, std::uint32_t key) {
  std::uint32_t low = counter_low, high = counter_high;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product = std::uint64_t(0xD256D193u) * low;
    low = std::uint32_t(product >> 32) ^ key ^ high;
    high = std::uint32_t(product);
    key += 0x9E3779B9u;
  }
  return {low, high};
}

/// A number in [0, 1) for element `index` at `step` of the run with `seed`.
NACRE_HD constexpr float uniform_random(std::uint32_t seed, std::uint32_t index, std::uint32_t step) {
  return float(philox(index, step, seed).a >> 8) * (1.0f / 16777216.0f);
}

}  // namespace nacre
