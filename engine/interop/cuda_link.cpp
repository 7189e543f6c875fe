// Nacre: an OpenGL buffer as CUDA sees it.
#include "engine/interop/cuda_link.hpp"

#include "compute/device/error.hpp"

#if NACRE_HAS_CUDA && !NACRE_HIP

#include <GL/glew.h>
#include <cuda_gl_interop.h>

#include <algorithm>
#include <array>

#include "compute/device/cuda_check.hpp"
#include "compute/device/cuda_device.hpp"

namespace nacre {
namespace {

class RegisteredBuffer final : public CudaLink {
 public:
  RegisteredBuffer(const CudaDevice& device, GLuint buffer) : device_(device), stream_(device.stream()) {
    device_.use();
    cuda_check(cudaGraphicsGLRegisterBuffer(&resource_, buffer, cudaGraphicsRegisterFlagsWriteDiscard),
               "registering a buffer of OpenGL");
  }
  ~RegisteredBuffer() override {
    cudaSetDevice(device_.number());
    if (mapped_) cudaGraphicsUnmapResources(1, &resource_, stream_);
    cudaGraphicsUnregisterResource(resource_);
  }
  RegisteredBuffer(const RegisteredBuffer&) = delete;
  RegisteredBuffer& operator=(const RegisteredBuffer&) = delete;

  void* map() override {
    device_.use();
    cuda_check(cudaGraphicsMapResources(1, &resource_, stream_), "mapping a buffer of OpenGL");
    mapped_ = true;
    void* pointer = nullptr;
    std::size_t bytes = 0;
    cuda_check(cudaGraphicsResourceGetMappedPointer(&pointer, &bytes, resource_), "finding a buffer of OpenGL");
    return pointer;
  }

  void unmap() override {
    mapped_ = false;
    device_.use();
    cuda_check(cudaGraphicsUnmapResources(1, &resource_, stream_), "unmapping a buffer of OpenGL");
  }

 private:
  const CudaDevice& device_;
  cudaStream_t stream_;  ///< of the device: draws and launches are ordered by it
  cudaGraphicsResource_t resource_ = nullptr;
  bool mapped_ = false;
};

class PinnedBlock final : public PinnedMemory {
 public:
  explicit PinnedBlock(std::size_t bytes) { cuda_check(cudaMallocHost(&block_, bytes), "pinning host memory"); }
  ~PinnedBlock() override { cudaFreeHost(block_); }
  PinnedBlock(const PinnedBlock&) = delete;
  PinnedBlock& operator=(const PinnedBlock&) = delete;
  void* data() override { return block_; }

 private:
  void* block_ = nullptr;
};

}  // namespace

bool cuda_draws_here(const Device& device) {
  const auto* cuda = dynamic_cast<const CudaDevice*>(&device);
  if (!cuda) return false;
  std::array<int, 16> devices{};
  unsigned count = 0;
  if (cudaSetDevice(cuda->number()) != cudaSuccess ||
      cudaGLGetDevices(&count, devices.data(), unsigned(devices.size()), cudaGLDeviceListAll) != cudaSuccess) {
    cudaGetLastError();  // a context made by another vendor means "no", not an error
    return false;
  }
  return std::find(devices.begin(), devices.begin() + count, cuda->number()) != devices.begin() + count;
}

std::unique_ptr<CudaLink> link_cuda(Device& device, unsigned gl_buffer) {
  auto* cuda = dynamic_cast<CudaDevice*>(&device);
  if (!cuda) throw Error("CUDA cannot write into a buffer of OpenGL", "the device is " + device.name());
  return std::make_unique<RegisteredBuffer>(*cuda, gl_buffer);
}

std::unique_ptr<PinnedMemory> pin_memory(std::size_t bytes) { return std::make_unique<PinnedBlock>(bytes); }

}  // namespace nacre

#else

namespace nacre {

bool cuda_draws_here(const Device&) { return false; }

std::unique_ptr<CudaLink> link_cuda(Device&, unsigned) {
  throw Error("CUDA cannot write into a buffer of OpenGL", "this build has no CUDA");
}

std::unique_ptr<PinnedMemory> pin_memory(std::size_t) { throw Error("no pinned memory", "this build has no CUDA"); }

}  // namespace nacre

#endif
