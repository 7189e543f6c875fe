// Nacre: CUB's exclusive sum on an emulated device.
#pragma once

#include "cub/device/scratch.cuh"

namespace cub {

struct DeviceScan {
  template <class T, class Count>
  static cudaError_t ExclusiveSum(void* scratch, std::size_t& bytes, const T* in, T* out, Count n,
                                  cudaStream_t stream) {
    if (emulated_detail::asks_for_size(scratch, bytes, std::size_t(n))) return cudaSuccess;
    return emulated::enqueue(stream, "scan", [=, bytes = bytes] {
      emulated_detail::use_scratch(scratch, bytes);
      T sum = 0;
      for (Count i = 0; i < n; ++i) {
        const T value = in[i];  // in == out is allowed
        out[i] = sum;
        sum += value;
      }
    });
  }
};

}  // namespace cub
