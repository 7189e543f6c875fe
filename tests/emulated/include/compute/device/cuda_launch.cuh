// Nacre: how kernels are launched on the emulated device. Found before the file of the same name in compute/device.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>

#include "compute/device/cuda_lanes.cuh"

namespace nacre {

template <class Kernel>
void for_each_kernel(const Elements& all, const Kernel& kernel) {
  run_elements(all, kernel);
}

template <class Kernel>
void for_each_team_kernel(const Elements& all, const Kernel& kernel) {
  run_teams(all, kernel, emulated::shared_memory());
}

template <class Kernel>
void launch_elements(unsigned blocks, unsigned threads, cudaStream_t stream, const Elements& all,
                     const Kernel& kernel) {
  const auto* function = reinterpret_cast<const void*>(&for_each_kernel<Kernel>);
  emulated::launch({__PRETTY_FUNCTION__, function, false, blocks, threads, 0}, stream,
                   [all, kernel] { for_each_kernel<Kernel>(all, kernel); });
}

template <class Kernel>
void launch_teams(unsigned blocks, std::size_t scratch, cudaStream_t stream, const Elements& all,
                  const Kernel& kernel) {
  const auto* function = reinterpret_cast<const void*>(&for_each_team_kernel<Kernel>);
  emulated::launch({__PRETTY_FUNCTION__, function, true, blocks, Team::lanes, scratch}, stream,
                   [all, kernel] { for_each_team_kernel<Kernel>(all, kernel); });
}

}  // namespace nacre
