// Nacre: every CUDA call is checked.
#pragma once

#include <cuda_runtime_api.h>

#include <string>

#include "compute/device/error.hpp"

namespace nacre {

inline void cuda_check(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // forgets the failure, or the next launch would be blamed for it
  throw Error(std::string("CUDA: ") + what + " failed", cudaGetErrorString(status));
}

}  // namespace nacre
