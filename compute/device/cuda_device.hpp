// Nacre: one NVIDIA GPU as a device.
#pragma once

#include <cuda_runtime_api.h>

#include <map>
#include <memory>
#include <mutex>

#include "compute/device/cuda_reservation.hpp"
#include "compute/device/device.hpp"

namespace nacre {

/// GPU `number`. All that is done through a device is done in one stream of its own, in the order of the calls; it does
/// not wait for the default stream, nor that for it. The stream is never captured (see Executor<Cuda>::repeat), so that
/// another thread may use the device at any time.
class CudaDevice final : public Device {
 public:
  CudaDevice(std::size_t arena_limit, int number);
  ~CudaDevice() override;
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;

  std::string backend() const override { return "cuda"; }
  std::string name() const override { return properties_.name; }
  int threads() const override { return 1; }
  std::string remark() const override;
  void* allocate(std::size_t bytes) override;
  void deallocate(void* block, std::size_t bytes) noexcept override;
  void* reserve(std::size_t bytes) override;
  void release(void* block, std::size_t bytes) noexcept override;
  void commit(void* block, std::size_t from, std::size_t to) override;
  std::size_t obtainable_bytes(const void* block, std::size_t from, std::size_t to) const override;
  std::string too_small(const std::string& advice) const override { return advice + ", or use `device` cpu"; }
  void copy_to_device(void* to, const void* host, std::size_t bytes) override;
  void copy_to_host(void* host, const void* from, std::size_t bytes) override;
  void fill(void* to, unsigned char value, std::size_t bytes) override;
  void synchronize() override;
  std::size_t available_bytes() const override;
  /// Leaves a fifth to the display and to others.
  std::size_t arena_bytes() const override;
  std::size_t peak_bytes() const override;

  /// Makes it the current device of this thread, to which CUDA's calls go.
  void use() const;
  int number() const { return number_; }
  cudaStream_t stream() const { return stream_; }

 private:
  void count(std::size_t taken);

  std::size_t arena_limit_;
  int number_;
  bool portable_code_ = false;
  cudaDeviceProp properties_{};
  cudaStream_t stream_ = nullptr;
  mutable std::mutex mutex_;  ///< guards what follows
  std::map<const void*, std::unique_ptr<CudaReservation>> reservations_;
  std::size_t in_use_ = 0, peak_ = 0;
};

}  // namespace nacre
