// Nacre: a kernel's blocks and threads, run one after the other in random order.
#pragma once

#include <cstddef>
#include <functional>

#include "cuda_runtime_api.h"

namespace emulated {

inline constexpr std::size_t shared_limit = std::size_t(64) << 10;    ///< bytes of a block: what sm_75, the least, has
inline constexpr std::size_t shared_unasked = std::size_t(48) << 10;  ///< without cudaFuncSetAttribute

/// Runs all threads of a launch to their end.
void run_grid(const Launch& launch, const std::function<void()>& lane);

}  // namespace emulated
