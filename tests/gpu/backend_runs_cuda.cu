// Nacre: what the GPU tests run, on CUDA.
#include "compute/device/executor_cuda.cuh"
#include "tests/gpu/backend_runs_impl.hpp"

namespace nacre::gpu_tests {

template <>
long graphs_made<Cuda>(const Steps& steps) {
  return steps.record ? static_cast<const CudaGraph&>(*steps.record).made() : 0;
}

std::unique_ptr<BackendRuns> make_runs(Cuda, Device& device) { return std::make_unique<BackendRunsOf<Cuda>>(device); }

}  // namespace nacre::gpu_tests
