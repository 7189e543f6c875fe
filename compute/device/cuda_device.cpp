// Nacre: one NVIDIA GPU as a device.
#if NACRE_HAS_CUDA

#include <cuda_runtime_api.h>

#include <algorithm>
#include <string>

#include "compute/device/cuda_check.hpp"
#include "compute/device/device.hpp"
#include "compute/device/error.hpp"

namespace nacre {
namespace {

class CudaDevice final : public Device {
 public:
  CudaDevice() {
    cuda_check(cudaSetDevice(0), "choosing the device");
    cuda_check(cudaGetDeviceProperties(&properties_, 0), "asking for the device's properties");
  }

  std::string backend() const override { return "cuda"; }
  std::string name() const override { return properties_.name; }
  int threads() const override { return 1; }

  void* allocate(std::size_t bytes) override {
    void* block = nullptr;
    if (cudaMalloc(&block, std::max<std::size_t>(bytes, 1)) != cudaSuccess)
      throw Error("not enough memory on the GPU", std::to_string(bytes >> 20) + " MiB asked", "lower the resolution");
    in_use_ += bytes;
    peak_ = std::max(peak_, in_use_);
    return block;
  }

  void deallocate(void* block, std::size_t bytes) noexcept override {
    cudaFree(block);
    in_use_ -= bytes;
  }

  void copy_to_device(void* to, const void* host, std::size_t bytes) override {
    cuda_check(cudaMemcpy(to, host, bytes, cudaMemcpyHostToDevice), "copy to the device");
  }

  void copy_to_host(void* host, const void* from, std::size_t bytes) override {
    cuda_check(cudaMemcpy(host, from, bytes, cudaMemcpyDeviceToHost), "copy from the device");
  }

  void fill(void* to, unsigned char value, std::size_t bytes) override {
    cuda_check(cudaMemset(to, value, bytes), "fill");
  }

  void synchronize() override { cuda_check(cudaDeviceSynchronize(), "wait"); }

  std::size_t available_bytes() const override {
    std::size_t free = 0, total = 0;
    cuda_check(cudaMemGetInfo(&free, &total), "asking for free memory");
    return free;
  }

  /// Device memory is not lazy: leave a fifth to the display and to others.
  std::size_t arena_bytes() const override { return available_bytes() / 5 * 4; }
  std::size_t peak_bytes() const override { return peak_; }

 private:
  cudaDeviceProp properties_{};
  std::size_t in_use_ = 0;
  std::size_t peak_ = 0;
};

}  // namespace

int cuda_device_count() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess ? count : 0;  // no driver is "none", not an error
}

std::unique_ptr<Device> make_cuda_device() {
  if (cuda_device_count() == 0)
    throw Error("no CUDA device", "no GPU, or no driver for it", "use --device cpu or --device auto");
  return std::make_unique<CudaDevice>();
}

}  // namespace nacre

#endif
