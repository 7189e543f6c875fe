// Nacre: counting and finding the set bits of a word.
#pragma once

#include <cstdint>

#include "compute/device/backend.hpp"

namespace nacre {

NACRE_HD_INLINE int count_bits(std::uint64_t v) {
#if defined(__CUDA_ARCH__)
  return __popcll(v);
#else
  return __builtin_popcountll(v);
#endif
}

/// Number of the lowest set bit; at least one bit must be set.
NACRE_HD_INLINE int lowest_bit(unsigned bits) {
#if defined(__CUDA_ARCH__)
  return __ffs(bits) - 1;
#else
  return __builtin_ctz(bits);
#endif
}

}  // namespace nacre
