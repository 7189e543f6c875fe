// Nacre: asks the driver for the smallest kernel of this build.
#include <cuda_runtime.h>

#include "compute/device/cuda_probe.hpp"

__global__ void nacre_probe() {}

nacre::CudaCode nacre::cuda_code() {
  cudaFuncAttributes made{};
  if (cudaFuncGetAttributes(&made, nacre_probe) != cudaSuccess) return CudaCode::none;
  return made.binaryVersion > made.ptxVersion ? CudaCode::portable : CudaCode::ready;
}
