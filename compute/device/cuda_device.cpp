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
namespace {

/// While it lives, this thread may do what a capture forbids, as far as it is no part of it: take memory, load kernels.
class BesideCapture {
 public:
  BesideCapture() { cudaThreadExchangeStreamCaptureMode(&mode_); }
  ~BesideCapture() { cudaThreadExchangeStreamCaptureMode(&mode_); }
  BesideCapture(const BesideCapture&) = delete;
  BesideCapture& operator=(const BesideCapture&) = delete;

 private:
  cudaStreamCaptureMode mode_ = cudaStreamCaptureModeRelaxed;
};

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

/// Why device `number` cannot be used; empty where it can.
std::string trouble_with(int number) {
  int driver = 0, runtime = 0, count = 0;
  if (cudaDriverGetVersion(&driver) != cudaSuccess || driver == 0) return "there is no NVIDIA driver";
  cudaRuntimeGetVersion(&runtime);
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status == cudaErrorInsufficientDriver)
    return "the driver is made for CUDA " + version_text(driver) + ", this build needs " + version_text(runtime);
  if (status != cudaSuccess) return cudaGetErrorString(status);
  if (number >= count) return "the number of GPUs is " + std::to_string(count);
  cudaDeviceProp device{};
  if (cudaGetDeviceProperties(&device, number) != cudaSuccess || cudaSetDevice(number) != cudaSuccess)
    return "GPU " + std::to_string(number) + " does not answer";
  if (cuda_code() == CudaCode::none)
    return std::string(device.name) + " has compute capability " + std::to_string(device.major) + "." +
           std::to_string(device.minor) + ", for which this build has no code";
  return {};
}

/// `trouble_with`, and CUDA's own memory of it is cleared: no GPU is an answer, not an error.
std::string checked_trouble(int number) {
  std::string trouble = trouble_with(number);
  if (!trouble.empty()) cudaGetLastError();
  return trouble;
}

}  // namespace

CudaDevice::CudaDevice(std::size_t arena_limit, int number)
    : arena_limit_(arena_limit > 0 ? arena_limit : std::numeric_limits<std::size_t>::max()), number_(number) {
  use();
  cuda_check(cudaGetDeviceProperties(&properties_, number_), "asking for the device's properties");
  cuda_check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream");
  portable_code_ = cuda_code() == CudaCode::portable;
}

CudaDevice::~CudaDevice() { cudaStreamDestroy(stream_); }

void CudaDevice::use() const { cuda_check(cudaSetDevice(number_), "choosing the device"); }

std::string CudaDevice::remark() const {
  if (!portable_code_) return {};
  return "this build has no code for " + name() +
         ": its driver translates every kernel before it runs first, which takes minutes, once";
}

void* CudaDevice::allocate(std::size_t bytes) {
  Recording::forbid("an allocation");
  use();
  void* block = nullptr;
  if (cudaMalloc(&block, std::max<std::size_t>(bytes, 1)) != cudaSuccess) {
    cudaGetLastError();  // forgets the failure, or the next launch would be blamed for it
    throw Error("not enough memory on the GPU", std::to_string(bytes >> 20) + " MiB asked",
                too_small("lower the resolution"));
  }
  count(bytes);
  return block;
}

void CudaDevice::deallocate(void* block, std::size_t bytes) noexcept {
  cudaSetDevice(number_);
  cudaFree(block);  // waits for all that may still use it
  const std::scoped_lock lock(mutex_);
  in_use_ -= bytes;
}

void* CudaDevice::reserve(std::size_t bytes) {
  Recording::forbid("an allocation");
  use();
  std::unique_ptr<CudaReservation> made;
  try {
    made = std::make_unique<CudaReservation>(number_, std::max<std::size_t>(bytes, 1));
  } catch (const Error&) {  // a driver without that
    return allocate(bytes);
  }
  void* const block = made->data();
  const std::scoped_lock lock(mutex_);
  reservations_[block] = std::move(made);
  return block;
}

void CudaDevice::release(void* block, std::size_t bytes) noexcept {
  std::unique_lock lock(mutex_);
  const auto found = reservations_.find(block);
  if (found == reservations_.end()) {
    lock.unlock();
    return deallocate(block, bytes);
  }
  cudaSetDevice(number_);
  cudaStreamSynchronize(stream_);  // what may still use it
  in_use_ -= found->second->committed_bytes();
  reservations_.erase(found);
}

void CudaDevice::commit(void* block, std::size_t from, std::size_t to) {
  const std::scoped_lock lock(mutex_);
  const auto found = reservations_.find(block);
  if (found == reservations_.end() || from >= to) return;
  const BesideCapture beside;
  CudaReservation& reservation = *found->second;
  const std::size_t before = reservation.committed_bytes();
  const auto note = [&] {
    in_use_ += reservation.committed_bytes() - before;
    peak_ = std::max(peak_, in_use_);
  };
  try {
    reservation.commit(from, to);
  } catch (...) {
    note();
    throw;
  }
  note();
}

std::size_t CudaDevice::obtainable_bytes(const void* block, std::size_t from, std::size_t to) const {
  const std::size_t free = available_bytes();
  const std::scoped_lock lock(mutex_);
  const auto found = reservations_.find(block);
  if (found == reservations_.end()) return to - from;  // it was allocated whole
  return std::min(to - from, found->second->committed_bytes(from, to) + free);
}

void CudaDevice::count(std::size_t taken) {
  const std::scoped_lock lock(mutex_);
  in_use_ += taken;
  peak_ = std::max(peak_, in_use_);
}

std::size_t CudaDevice::peak_bytes() const {
  const std::scoped_lock lock(mutex_);
  return peak_;
}

void CudaDevice::copy_to_device(void* to, const void* host, std::size_t bytes) {
  Recording::forbid("a copy to the device");
  use();
  cuda_check(cudaMemcpyAsync(to, host, bytes, cudaMemcpyHostToDevice, stream_), "copy to the device");
  cuda_check(cudaStreamSynchronize(stream_), "copy to the device");  // the caller may drop what it gave
}

void CudaDevice::copy_to_host(void* host, const void* from, std::size_t bytes) {
  Recording::forbid("a copy to the host");
  use();
  cuda_check(cudaMemcpyAsync(host, from, bytes, cudaMemcpyDeviceToHost, stream_), "copy from the device");
  cuda_check(cudaStreamSynchronize(stream_), "copy from the device");
}

void CudaDevice::fill(void* to, unsigned char value, std::size_t bytes) {
  Recording::forbid("a fill at once");
  use();
  cuda_check(cudaMemsetAsync(to, value, bytes, stream_), "fill");
}

void CudaDevice::synchronize() {
  Recording::forbid("a wait");
  use();
  cuda_check(cudaStreamSynchronize(stream_), "wait");
}

std::size_t CudaDevice::available_bytes() const {
  std::size_t free = 0, total = 0;
  use();
  cuda_check(cudaMemGetInfo(&free, &total), "asking for free memory");
  return free;
}

std::size_t CudaDevice::arena_bytes() const { return std::min(available_bytes() / 5 * 4, arena_limit_); }

int cuda_device_count() {
  int count = 0;
  if (checked_trouble(0).empty()) cudaGetDeviceCount(&count);
  return count;
}

std::string why_no_cuda() {
  int driver = 0;
  if (cudaDriverGetVersion(&driver) != cudaSuccess || driver == 0) return {};
  return checked_trouble(0);
}

std::unique_ptr<Device> make_cuda_device(std::size_t arena_limit, int number) {
  const std::string trouble = checked_trouble(number);
  if (!trouble.empty()) throw Error("no CUDA device", trouble, "use `device` cpu or `device` auto");
  return std::make_unique<CudaDevice>(arena_limit, number);
}

}  // namespace nacre

#endif
