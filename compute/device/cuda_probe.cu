// Nacre: asks the driver for the smallest kernel of this build.
#include <cuda_runtime.h>

#include "compute/device/cuda_probe.hpp"

__global__ void nacre_probe() {}

bool nacre::cuda_code_runs() {
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, nacre_probe) == cudaSuccess;
}
