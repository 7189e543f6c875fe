// Nacre: how kernels are launched on CUDA: all that nvcc alone can compile. The tests on an emulated device have a file
// of their own in its place (tests/emulated/include).
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>

#include "compute/device/cuda_lanes.cuh"

namespace nacre {

template <class Kernel>
__global__ void for_each_kernel(std::int64_t n, const __grid_constant__ Kernel kernel) {
  run_elements(n, kernel);
}

template <class Kernel>
__global__ void for_each_team_kernel(std::int64_t n, const __grid_constant__ Kernel kernel) {
  extern __shared__ __align__(16) unsigned char scratch[];
  run_teams(n, kernel, scratch);
}

/// Both leave a failure to cudaGetLastError.
template <class Kernel>
void launch_elements(unsigned blocks, unsigned threads, cudaStream_t stream, std::int64_t n, const Kernel& kernel) {
  for_each_kernel<<<blocks, threads, 0, stream>>>(n, kernel);
}

template <class Kernel>
void launch_teams(unsigned blocks, std::size_t scratch, cudaStream_t stream, std::int64_t n, const Kernel& kernel) {
  for_each_team_kernel<<<blocks, Team::lanes, scratch, stream>>>(n, kernel);
}

}  // namespace nacre
