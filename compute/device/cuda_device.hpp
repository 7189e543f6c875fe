// Nacre: one NVIDIA GPU as a device.
#pragma once

#include <cuda_runtime_api.h>

#include "compute/device/device.hpp"

namespace nacre {

/// The first GPU. All that is done through a device is done in one stream of its own, in the order of the calls; it
/// does not wait for the default stream, nor that for it. The stream is never captured (see Executor<Cuda>::repeat), so
/// that another thread may use the device at any time.
class CudaDevice final : public Device {
 public:
  explicit CudaDevice(std::size_t arena_limit);
  ~CudaDevice() override;
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;

  std::string backend() const override { return "cuda"; }
  std::string name() const override { return properties_.name; }
  int threads() const override { return 1; }
  void* allocate(std::size_t bytes) override;
  void deallocate(void* block, std::size_t bytes) noexcept override;
  void copy_to_device(void* to, const void* host, std::size_t bytes) override;
  void copy_to_host(void* host, const void* from, std::size_t bytes) override;
  void fill(void* to, unsigned char value, std::size_t bytes) override;
  void synchronize() override;
  std::size_t available_bytes() const override;
  /// Device memory is not lazy: leave a fifth to the display and to others.
  std::size_t arena_bytes() const override;
  std::size_t peak_bytes() const override { return peak_; }

  cudaStream_t stream() const { return stream_; }

 private:
  std::size_t arena_limit_;
  cudaDeviceProp properties_{};
  cudaStream_t stream_ = nullptr;
  std::size_t in_use_ = 0;
  std::size_t peak_ = 0;
};

}  // namespace nacre
