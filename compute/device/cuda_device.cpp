// Nacre: one NVIDIA GPU as a device.
#if NACRE_HAS_CUDA

#include <cuda_runtime_api.h>

#include <algorithm>
#include <limits>
#include <string>

#include "compute/device/cuda_check.hpp"
#include "compute/device/cuda_probe.hpp"
#include "compute/device/device.hpp"
#include "compute/device/error.hpp"

namespace nacre {
namespace {

class CudaDevice final : public Device {
 public:
  explicit CudaDevice(std::size_t arena_limit)
      : arena_limit_(arena_limit > 0 ? arena_limit : std::numeric_limits<std::size_t>::max()) {
    cuda_check(cudaSetDevice(0), "choosing the device");
    cuda_check(cudaGetDeviceProperties(&properties_, 0), "asking for the device's properties");
  }

  std::string backend() const override { return "cuda"; }
  std::string name() const override { return properties_.name; }
  int threads() const override { return 1; }

  void* allocate(std::size_t bytes) override {
    void* block = nullptr;
    if (cudaMalloc(&block, std::max<std::size_t>(bytes, 1)) != cudaSuccess) {
      cudaGetLastError();  // forgets the failure, or the next launch would be blamed for it
      throw Error("not enough memory on the GPU", std::to_string(bytes >> 20) + " MiB asked", "lower the resolution");
    }
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
  std::size_t arena_bytes() const override { return std::min(available_bytes() / 5 * 4, arena_limit_); }
  std::size_t peak_bytes() const override { return peak_; }

 private:
  std::size_t arena_limit_;
  cudaDeviceProp properties_{};
  std::size_t in_use_ = 0;
  std::size_t peak_ = 0;
};

}  // namespace

int cuda_device_count() {
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0 || !cuda_code_runs()) {
    cudaGetLastError();  // no driver, an old one or an unknown GPU is "none", not an error
    return 0;
  }
  return count;
}

std::unique_ptr<Device> make_cuda_device(std::size_t arena_limit) {
  if (cuda_device_count() == 0)
    throw Error("no CUDA device", "no GPU, no driver for it, or a GPU that this build has no code for",
                "use --device cpu or --device auto");
  return std::make_unique<CudaDevice>(arena_limit);
}

}  // namespace nacre

#endif
