// Nacre: what the GPU tests run, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/gpu/backend_runs_impl.hpp"

namespace nacre::gpu_tests {

template <>
long graphs_made<Cpu>(const Steps&) {
  return 0;
}

std::unique_ptr<BackendRuns> make_runs(Cpu, Device& device) { return std::make_unique<BackendRunsOf<Cpu>>(device); }

}  // namespace nacre::gpu_tests
