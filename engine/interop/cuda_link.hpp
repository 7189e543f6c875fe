// Nacre: an OpenGL buffer as CUDA sees it. It includes no header of CUDA, so that a build without CUDA has the same
// code.
#pragma once

#include <cstddef>
#include <memory>

#include "compute/device/device.hpp"

namespace nacre {

/// One OpenGL buffer, registered with CUDA for the lifetime of this object. OpenGL must not use it between map and
/// unmap. All calls on the thread of the context.
class CudaLink {
 public:
  virtual ~CudaLink() = default;
  virtual void* map() = 0;   ///< its device pointer; later work of the device waits for draws that use it. Throws Error
  virtual void unmap() = 0;  ///< further draws wait for the work queued on the device
};

/// Host memory that CUDA copies to at full speed.
class PinnedMemory {
 public:
  virtual ~PinnedMemory() = default;
  virtual void* data() = 0;
};

/// Whether the current context is on the GPU that CUDA computes on. False in a build without CUDA.
bool cuda_draws_here();

/// Registers the buffer named `gl_buffer` for `device`, a CUDA device. Throws Error if CUDA cannot do that, or in a
/// build without CUDA.
std::unique_ptr<CudaLink> link_cuda(Device& device, unsigned gl_buffer);

/// Throws Error if there is not that much memory, or in a build without CUDA.
std::unique_ptr<PinnedMemory> pin_memory(std::size_t bytes);

}  // namespace nacre
