// Nacre: what the threads of a launch do on CUDA.
#pragma once

#include <cstdint>

#include "compute/device/team.hpp"

namespace nacre {

/// Elements first .. end-1 of a launch.
struct Elements {
  std::int64_t first, end;
};

/// kernel(i) for the share of `all` that is this thread's.
template <class Kernel>
__device__ __forceinline__ void run_elements(const Elements& all, const Kernel& kernel) {
  const std::int64_t stride = std::int64_t(gridDim.x) * blockDim.x;
  for (std::int64_t i = all.first + std::int64_t(blockIdx.x) * blockDim.x + threadIdx.x; i < all.end; i += stride)
    kernel(i);
}

/// kernel(team, i) for the share of `all` that is this block's, a team. `scratch`: shared memory.
template <class Kernel>
__device__ __forceinline__ void run_teams(const Elements& all, const Kernel& kernel, unsigned char* scratch) {
  Team team(scratch);
  for (std::int64_t i = all.first + blockIdx.x; i < all.end; i += gridDim.x) {
    kernel(team, i);
    __syncthreads();  // the next item has the same scratch
  }
}

}  // namespace nacre
