// Nacre: a team of lanes that works on one item together: one thread that loops over its lanes on the CPU, a block of
// threads on CUDA.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compute/device/backend.hpp"

namespace nacre {

/// Passed to the kernels of Executor::for_each_team. Every lane runs the kernel's code between the calls, with the same
/// values; only what is inside of `each`, `sum` and `compact` is shared out. These end with all lanes seeing what all
/// have written.
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

  /// put(k, place) for those of 0 <= k < n, n <= 64, that flag(k) says yes to: places 0, 1, ... in their order. Returns
  /// how many.
  template <class Flag, class Put>
  __device__ int compact(int n, const Flag& flag, const Put& put) {
    static_assert(lanes == 64, "two warps");
    const int lane = threadIdx.x;
    const bool mine = lane < n && flag(lane);
    const unsigned votes = __ballot_sync(0xffffffffu, mine);
    auto* both = reinterpret_cast<unsigned*>(scratch_);
    if (lane % 32 == 0) both[lane / 32] = votes;
    __syncthreads();
    const int before = __popc(votes & ((1u << lane % 32) - 1)) + (lane >= 32 ? __popc(both[0]) : 0);
    if (mine) put(lane, before);
    const int total = __popc(both[0]) + __popc(both[1]);
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
  template <class Flag, class Put>
  NACRE_HD_INLINE int compact(int n, const Flag& flag, const Put& put) {
    std::uint32_t yes[lanes];  // without a branch, in vector instructions
    for (int k = 0; k < n; ++k) yes[k] = std::uint32_t(flag(k));
    std::uint8_t list[lanes + 1];
    int total = 0;
    for (int k = 0; k < n; ++k) {
      list[total] = std::uint8_t(k);
      total += int(yes[k]);
    }
    for (int k = 0; k < total; ++k) put(list[k], k);
    return total;
  }
  NACRE_HD bool first() const { return true; }
  NACRE_HD void wait() {}
#endif

  /// Memory that the team shares, behind what `sum` and `compact` use. The kernel lays it out; its size is the kernel's
  /// `scratch_bytes()`.
  NACRE_HD unsigned char* scratch() const { return scratch_ + sum_bytes; }
  static constexpr std::size_t sum_bytes = lanes * 64;  ///< T of `sum` has at most 64 bytes

 private:
  unsigned char* scratch_;
};

}  // namespace nacre
