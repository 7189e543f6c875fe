// Nacre: what GPU this is and how fast its memory is copied, as one JSON object. Usage: gpu_info [MIB]
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "compute/device/cuda_check.hpp"
#include "compute/device/device.hpp"

namespace {

/// Bytes read plus bytes written per second by a copy from device memory to device memory, median of 15.
double copy_rate(std::size_t bytes) {
  using nacre::cuda_check;
  void *from = nullptr, *to = nullptr;
  cuda_check(cudaMalloc(&from, bytes), "allocation");
  cuda_check(cudaMalloc(&to, bytes), "allocation");
  cuda_check(cudaMemset(from, 0x5a, bytes), "fill");
  cudaEvent_t start{}, end{};
  cuda_check(cudaEventCreate(&start), "event");
  cuda_check(cudaEventCreate(&end), "event");
  std::vector<double> rates;
  for (int k = -3; k < 15; ++k) {
    cuda_check(cudaEventRecord(start), "event");
    cuda_check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice), "copy");
    cuda_check(cudaEventRecord(end), "event");
    cuda_check(cudaEventSynchronize(end), "wait");
    float milliseconds = 0;
    cuda_check(cudaEventElapsedTime(&milliseconds, start, end), "timing");
    if (k >= 0) rates.push_back(2.0 * double(bytes) / (milliseconds * 1e-3));
  }
  cudaEventDestroy(start);
  cudaEventDestroy(end);
  cudaFree(from);
  cudaFree(to);
  std::sort(rates.begin(), rates.end());
  return rates[rates.size() / 2];
}

void print_info(std::size_t mib) {
  using nacre::cuda_check;
  cudaDeviceProp device{};
  int driver = 0, runtime = 0;
  std::size_t free = 0, total = 0;
  cuda_check(cudaGetDeviceProperties(&device, 0), "asking for the device's properties");
  cuda_check(cudaDriverGetVersion(&driver), "asking for the driver's version");
  cuda_check(cudaRuntimeGetVersion(&runtime), "asking for the runtime's version");
  cuda_check(cudaMemGetInfo(&free, &total), "asking for free memory");
  std::printf(
      "{\n  \"name\": \"%s\",\n  \"compute_capability\": \"%d.%d\",\n  \"multiprocessors\": %d,\n"
      "  \"driver\": %d,\n  \"runtime\": %d,\n  \"total_bytes\": %zu,\n  \"free_bytes\": %zu,\n",
      device.name, device.major, device.minor, device.multiProcessorCount, driver, runtime, total, free);
  const std::size_t bytes = std::min(mib << 20, free / 4);
  std::printf("  \"copy_bytes\": %zu,\n  \"copy_bytes_per_second\": %.4g\n}\n", bytes, copy_rate(bytes));
}

}  // namespace

int main(int argc, char** argv) {
  if (nacre::cuda_device_count() == 0) {
    std::puts("no CUDA device: nothing was tested");
    return 77;
  }
  try {
    print_info(argc > 1 ? std::max(1ul, std::strtoul(argv[1], nullptr, 10)) : 1024);
    return 0;
  } catch (const nacre::Error& error) {
    std::fprintf(stderr, "gpu_info: %s\n", error.what());
    return 1;
  }
}
