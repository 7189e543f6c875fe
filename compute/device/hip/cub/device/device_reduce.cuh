// Nacre: CUB's reduction by rocPRIM.
#pragma once

#include "compute/device/hip/cub/device/scratch.cuh"

namespace cub {

struct DeviceReduce {
  template <class In, class T, class Count, class Merge>
  static cudaError_t Reduce(void* scratch, std::size_t& bytes, In in, T* out, Count n, Merge merge, T identity,
                            cudaStream_t stream) {
    return rocprim::reduce(scratch, bytes, in, out, identity, std::size_t(n), merge, stream);
  }
};

}  // namespace cub
