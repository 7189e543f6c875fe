// Nacre: what the GPU tests run, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/gpu/backend_runs_impl.hpp"

std::unique_ptr<nacre::gpu_tests::BackendRuns> nacre::gpu_tests::make_runs(Cpu, Device& device) {
  return std::make_unique<BackendRunsOf<Cpu>>(device);
}
