// Nacre: one test body, run on every device that this machine has.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "compute/device/device.hpp"
#include "compute/device/executor.hpp"

/// NACRE_DEVICE_TEST(suite, body) runs `template <class Backend> void body(Executor<Backend>&)`: compiled as C++ on
/// the CPU and on the CPU whose memory pretends to be remote, compiled by nvcc on the first CUDA device (skips where
/// there is none). Bodies live in `*_body.hpp`; `*_test.cpp` includes executor_cpu.hpp and the body, a `.cu`
/// executor_cuda.cuh and the body, nothing else. Bodies of one program with the same name lie in namespaces of their
/// own, or the linker would take one for all.
#if defined(__CUDACC__)
#define NACRE_DEVICE_TEST(suite, body)                                     \
  TEST(suite, body##OnCuda) {                                              \
    if (nacre::cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device"; \
    const auto device = nacre::make_cuda_device(std::size_t(1) << 30);     \
    nacre::Executor<nacre::Cuda> exec(*device);                            \
    body(exec);                                                            \
  }
#else
#define NACRE_DEVICE_TEST(suite, body)                   \
  TEST(suite, body##OnCpu) {                             \
    const auto device = nacre::make_cpu_device();        \
    nacre::Executor<nacre::Cpu> exec(*device);           \
    body(exec);                                          \
  }                                                      \
  TEST(suite, body##OnRemoteCpu) {                       \
    const auto device = nacre::make_cpu_device(0, true); \
    nacre::Executor<nacre::Cpu> exec(*device);           \
    body(exec);                                          \
  }
#endif
