// Nacre: bits of a word, counted and found.
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

/// Number of the lowest bit that is set; there must be one.
NACRE_HD_INLINE int lowest_bit(unsigned bits) {
#if defined(__CUDA_ARCH__)
  return __ffs(bits) - 1;
#else
  return __builtin_ctz(bits);
#endif
}

}  // namespace nacre
