// Nacre: the names of CUDA C++ that HIP lacks.
#pragma once

#include <cuda_runtime_api.h>

/// The votes of 32 lanes, also where a wave has 64: the half of it that the caller is in.
__device__ __forceinline__ unsigned __ballot_sync(unsigned, bool mine) {
  return unsigned(__ballot(mine) >> (threadIdx.x & (warpSize - 1) & ~31u));
}
