// Nacre: the GPU tests: 0 all well, 1 a test failed, 77 there is no CUDA device to test.
#include <gtest/gtest.h>

#include <cstdio>

#include "compute/device/device.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const bool lists = testing::GTEST_FLAG(list_tests);
  if (!lists && nacre::cuda_device_count() == 0) {  // what runs on the CPU, other tests run there, too
    std::puts("no CUDA device: nothing was tested on one");
    return 77;
  }
  return RUN_ALL_TESTS();
}
