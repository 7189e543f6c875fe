// Nacre: the GPU tests: 0 all well, 1 a test failed, 77 nothing failed but there is no CUDA device to test.
#include <gtest/gtest.h>

#include <cstdio>

#include "compute/device/device.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (RUN_ALL_TESTS() != 0) return 1;
  if (nacre::cuda_device_count() > 0) return 0;
  std::puts("no CUDA device: nothing was tested on one");
  return 77;
}
