// Nacre: what the GPU tests run, on CUDA.
#include "compute/device/executor_cuda.cuh"
#include "tests/gpu/backend_runs_impl.hpp"

std::unique_ptr<nacre::gpu_tests::BackendRuns> nacre::gpu_tests::make_runs(Cuda, Device& device) {
  return std::make_unique<BackendRunsOf<Cuda>>(device);
}
