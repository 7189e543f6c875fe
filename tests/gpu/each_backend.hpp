// Nacre: one test body for the backends that this machine has; the others are skipped aloud.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "compute/device/device.hpp"
#include "tests/compute/small_cases.hpp"
#include "tests/gpu/backend_runs.hpp"

namespace nacre::gpu_tests {

inline constexpr std::size_t arena_limit = std::size_t(1) << 30;  // tests take turns: none needs the whole GPU

using test::small_cases;

/// Makes `device` of the backend that the test is instantiated for; the CPU with memory that pretends to be remote.
class EachBackend : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "cuda" && cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
    device = GetParam() == "cuda" ? make_cuda_device(arena_limit) : make_cpu_device(0, true);
    runs = GetParam() == "cuda" ? make_runs(Cuda{}, *device) : make_runs(Cpu{}, *device);
  }

  std::unique_ptr<Device> device;
  std::unique_ptr<BackendRuns> runs;
};

inline std::string backend_name(const testing::TestParamInfo<std::string>& info) { return info.param; }

}  // namespace nacre::gpu_tests
