// Nacre: what the threads of a launch do on CUDA.
#pragma once

#include <cstdint>

#include "compute/device/team.hpp"

namespace nacre {

/// kernel(i) for the share of 0 .. n-1 that is this thread's.
template <class Kernel>
__device__ __forceinline__ void run_elements(std::int64_t n, const Kernel& kernel) {
  const std::int64_t stride = std::int64_t(gridDim.x) * blockDim.x;
  for (std::int64_t i = std::int64_t(blockIdx.x) * blockDim.x + threadIdx.x; i < n; i += stride) kernel(i);
}

/// kernel(team, i) for the share of 0 .. n-1 that is this block's, a team. `scratch`: shared memory.
template <class Kernel>
__device__ __forceinline__ void run_teams(std::int64_t n, const Kernel& kernel, unsigned char* scratch) {
  Team team(scratch);
  for (std::int64_t i = blockIdx.x; i < n; i += gridDim.x) {
    kernel(team, i);
    __syncthreads();  // the next item has the same scratch
  }
}

}  // namespace nacre
