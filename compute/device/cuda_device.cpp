// Nacre: one NVIDIA GPU as a device.
#if NACRE_HAS_CUDA

#include "compute/device/cuda_device.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "compute/device/cuda_check.hpp"
#include "compute/device/cuda_probe.hpp"
#include "compute/device/error.hpp"

namespace nacre {

CudaDevice::CudaDevice(std::size_t arena_limit)
    : arena_limit_(arena_limit > 0 ? arena_limit : std::numeric_limits<std::size_t>::max()) {
  cuda_check(cudaSetDevice(0), "choosing the device");
  cuda_check(cudaGetDeviceProperties(&properties_, 0), "asking for the device's properties");
  cuda_check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream");
}

CudaDevice::~CudaDevice() { cudaStreamDestroy(stream_); }

void* CudaDevice::allocate(std::size_t bytes) {
  Recording::forbid("an allocation");
  void* block = nullptr;
  if (cudaMalloc(&block, std::max<std::size_t>(bytes, 1)) != cudaSuccess) {
    cudaGetLastError();  // forgets the failure, or the next launch would be blamed for it
    throw Error("not enough memory on the GPU", std::to_string(bytes >> 20) + " MiB asked", "lower the resolution");
  }
  in_use_ += bytes;
  peak_ = std::max(peak_, in_use_);
  return block;
}

void CudaDevice::deallocate(void* block, std::size_t bytes) noexcept {
  cudaFree(block);  // waits for all that may still use it
  in_use_ -= bytes;
}

void CudaDevice::copy_to_device(void* to, const void* host, std::size_t bytes) {
  Recording::forbid("a copy to the device");
  cuda_check(cudaMemcpyAsync(to, host, bytes, cudaMemcpyHostToDevice, stream_), "copy to the device");
  cuda_check(cudaStreamSynchronize(stream_), "copy to the device");  // the caller may drop what it gave
}

void CudaDevice::copy_to_host(void* host, const void* from, std::size_t bytes) {
  Recording::forbid("a copy to the host");
  cuda_check(cudaMemcpyAsync(host, from, bytes, cudaMemcpyDeviceToHost, stream_), "copy from the device");
  cuda_check(cudaStreamSynchronize(stream_), "copy from the device");
}

void CudaDevice::fill(void* to, unsigned char value, std::size_t bytes) {
  Recording::forbid("a fill at once");
  cuda_check(cudaMemsetAsync(to, value, bytes, stream_), "fill");
}

void CudaDevice::synchronize() {
  Recording::forbid("a wait");
  cuda_check(cudaStreamSynchronize(stream_), "wait");
}

std::size_t CudaDevice::available_bytes() const {
  std::size_t free = 0, total = 0;
  cuda_check(cudaMemGetInfo(&free, &total), "asking for free memory");
  return free;
}

std::size_t CudaDevice::arena_bytes() const { return std::min(available_bytes() / 5 * 4, arena_limit_); }

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
                "use `device` cpu or `device` auto");
  return std::make_unique<CudaDevice>(arena_limit);
}

}  // namespace nacre

#endif
