// Nacre: what the emulated primitives of CUB share: the call that asks for the size of the scratch, and its use.
#pragma once

#include <cstddef>
#include <cstring>

#include "cuda_runtime_api.h"

namespace cub::emulated_detail {

/// Is this the call that asks how much scratch is needed? It gets an answer that depends on n, as from CUB.
inline bool asks_for_size(void* scratch, std::size_t& bytes, std::size_t n) {
  if (scratch) return false;
  bytes = 256 + n / 64;
  return true;
}

/// CUB leaves anything there: who kept something in the same memory shall notice.
inline void use_scratch(void* scratch, std::size_t bytes) { std::memset(scratch, 0xee, bytes); }

}  // namespace cub::emulated_detail
