// Nacre: how kernels are launched on CUDA: all that nvcc alone can compile. The tests on an emulated device have a file
// of their own instead (tests/emulated/include).
#pragma once

#include <cuda_runtime.h>

#include <cstddef>

#include "compute/device/cuda_lanes.cuh"

namespace nacre {

template <class Kernel>
__global__ void for_each_kernel(const Elements all, const __grid_constant__ Kernel kernel) {
  run_elements(all, kernel);
}

template <class Kernel>
__global__ void for_each_team_kernel(const Elements all, const __grid_constant__ Kernel kernel) {
  extern __shared__ __align__(16) unsigned char scratch[];
  run_teams(all, kernel, scratch);
}

/// Both leave a failure to cudaGetLastError.
template <class Kernel>
void launch_elements(unsigned blocks, unsigned threads, cudaStream_t stream, const Elements& all,
                     const Kernel& kernel) {
  for_each_kernel<<<blocks, threads, 0, stream>>>(all, kernel);
}

template <class Kernel>
void launch_teams(unsigned blocks, std::size_t scratch, cudaStream_t stream, const Elements& all,
                  const Kernel& kernel) {
  for_each_team_kernel<<<blocks, Team::lanes, scratch, stream>>>(all, kernel);
}

}  // namespace nacre
