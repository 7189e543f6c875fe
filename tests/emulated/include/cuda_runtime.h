// Nacre: the words of CUDA C++ that kernels are written with, for an emulated device.
#pragma once

#include <bit>
#include <cmath>
#include <type_traits>

#include "cuda_runtime_api.h"

#define __host__
#define __device__
#define __global__
#define __forceinline__ inline __attribute__((always_inline))
#define __grid_constant__

struct alignas(8) short4 {
  short x, y, z, w;
};

namespace emulated {

struct Index {
  unsigned x = 0;
};
extern Index thread_index, block_index, block_size, grid_size;

/// Of the block that runs.
unsigned char* shared_memory();

/// Both end when all lanes (of the block, of the warp) have come to the same position in the code.
void barrier(const void* position);
unsigned ballot(const void* position, bool mine);

/// Where its caller goes on: another value for each position in the code that it is called from.
[[gnu::noinline]] inline const void* here() { return __builtin_return_address(0); }

}  // namespace emulated

#define threadIdx emulated::thread_index
#define blockIdx emulated::block_index
#define blockDim emulated::block_size
#define gridDim emulated::grid_size
#define __syncthreads() emulated::barrier(emulated::here())
#define __ballot_sync(mask, mine) emulated::ballot(emulated::here(), mine)

inline int __popc(unsigned v) { return std::popcount(v); }
inline int __popcll(unsigned long long v) { return std::popcount(v); }
inline int __ffs(int v) { return __builtin_ffs(v); }
inline int __float_as_int(float f) { return std::bit_cast<int>(f); }

inline unsigned __ldcg(const unsigned* from) { return __atomic_load_n(from, __ATOMIC_RELAXED); }
inline void __stcg(unsigned* to, unsigned value) { __atomic_store_n(to, value, __ATOMIC_RELAXED); }

template <class T>
T atomicAdd(T* to, std::type_identity_t<T> v) {
  return __atomic_fetch_add(to, v, __ATOMIC_RELAXED);
}
template <class T>
T atomicOr(T* to, std::type_identity_t<T> bits) {
  return __atomic_fetch_or(to, bits, __ATOMIC_RELAXED);
}
template <class T>
T atomicMin(T* to, std::type_identity_t<T> v) {
  T old = __atomic_load_n(to, __ATOMIC_RELAXED);
  while (v < old && !__atomic_compare_exchange_n(to, &old, v, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return old;
}
