// Nacre: CUB's exclusive sum by rocPRIM.
#pragma once

#include "compute/device/hip/cub/device/scratch.cuh"

namespace cub {

struct DeviceScan {
  template <class T, class Count>
  static cudaError_t ExclusiveSum(void* scratch, std::size_t& bytes, const T* in, T* out, Count n,
                                  cudaStream_t stream) {
    return rocprim::exclusive_scan(scratch, bytes, in, out, T(0), std::size_t(n), rocprim::plus<T>(), stream);
  }
};

}  // namespace cub
