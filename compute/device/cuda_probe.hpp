// Nacre: whether and how the GPU can run the code of this build.
#pragma once

namespace nacre {

enum class CudaCode {
  none,      ///< the current GPU is of an architecture that this build has neither code nor a portable form for
  ready,     ///< it runs what nvcc made
  portable,  ///< the driver must translate each kernel before it runs first
};

/// For the current GPU.
CudaCode cuda_code();

}  // namespace nacre
