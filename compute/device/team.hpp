// Nacre: a team of lanes that works on one item together: one thread that loops over its lanes on the CPU, a block of
// threads on CUDA.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compute/device/backend.hpp"

namespace nacre {

/// Passed to the kernels of Executor::for_each_team. Every lane runs the kernel's code between the calls, with the same
/// values; only what is inside of `each` and `sum` is shared out. Both end with all lanes seeing what all have written.
class Team {
 public:
  static constexpr int lanes = 64;  ///< on CUDA

#if defined(__CUDA_ARCH__)
  __device__ explicit Team(unsigned char* scratch) : scratch_(scratch) {}

  template <class Body>
  __device__ void each(int n, const Body& body) {
    for (int k = threadIdx.x; k < n; k += lanes) body(k);
    __syncthreads();
  }

  /// The sum of get(k) over 0 <= k < n, in an order that depends on n alone.
  template <class T, class Get>
  __device__ T sum(int n, const T& zero, const Get& get) {
    T* partial = reinterpret_cast<T*>(scratch_);
    T mine = zero;
    for (int k = threadIdx.x; k < n; k += lanes) mine = mine + get(k);
    partial[threadIdx.x] = mine;
    __syncthreads();
    for (int half = lanes / 2; half > 0; half /= 2) {
      if (int(threadIdx.x) < half) partial[threadIdx.x] = partial[threadIdx.x] + partial[threadIdx.x + half];
      __syncthreads();
    }
    const T total = partial[0];
    __syncthreads();
    return total;
  }

  /// True in one lane: for what must happen once.
  __device__ bool first() const { return threadIdx.x == 0; }
  __device__ void wait() { __syncthreads(); }
#else
  NACRE_HD explicit Team(unsigned char* scratch) : scratch_(scratch) {}

  template <class Body>
  NACRE_HD_INLINE void each(int n, const Body& body) {
    for (int k = 0; k < n; ++k) body(k);
  }
  template <class T, class Get>
  NACRE_HD_INLINE T sum(int n, const T& zero, const Get& get) {
    T total = zero;
    for (int k = 0; k < n; ++k) total = total + get(k);
    return total;
  }
  NACRE_HD bool first() const { return true; }
  NACRE_HD void wait() {}
#endif

  /// Memory that the team shares, behind what `sum` uses. The kernel lays it out; its size is the kernel's
  /// `scratch_bytes()`.
  NACRE_HD unsigned char* scratch() const { return scratch_ + sum_bytes; }
  static constexpr std::size_t sum_bytes = lanes * 64;  ///< T of `sum` has at most 64 bytes

 private:
  unsigned char* scratch_;
};

}  // namespace nacre
