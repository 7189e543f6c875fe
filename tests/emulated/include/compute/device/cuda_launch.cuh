// Nacre: how kernels are launched on the emulated device. Found before the file of the same name in compute/device.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "compute/device/cuda_lanes.cuh"

namespace nacre {

template <class Kernel>
void for_each_kernel(std::int64_t n, const Kernel& kernel) {
  run_elements(n, kernel);
}

template <class Kernel>
void for_each_team_kernel(std::int64_t n, const Kernel& kernel) {
  run_teams(n, kernel, emulated::shared_memory());
}

template <class Kernel>
void launch_elements(unsigned blocks, unsigned threads, cudaStream_t stream, std::int64_t n, const Kernel& kernel) {
  const auto* function = reinterpret_cast<const void*>(&for_each_kernel<Kernel>);
  emulated::launch({__PRETTY_FUNCTION__, function, false, blocks, threads, 0}, stream,
                   [n, kernel] { for_each_kernel<Kernel>(n, kernel); });
}

template <class Kernel>
void launch_teams(unsigned blocks, std::size_t scratch, cudaStream_t stream, std::int64_t n, const Kernel& kernel) {
  const auto* function = reinterpret_cast<const void*>(&for_each_team_kernel<Kernel>);
  emulated::launch({__PRETTY_FUNCTION__, function, true, blocks, Team::lanes, scratch}, stream,
                   [n, kernel] { for_each_team_kernel<Kernel>(n, kernel); });
}

}  // namespace nacre
