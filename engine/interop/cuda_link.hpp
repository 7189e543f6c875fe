// Nacre: an OpenGL buffer as CUDA sees it. No header of CUDA is seen here, so that a build without CUDA has the same
// code.
#pragma once

#include <cstddef>
#include <memory>

#include "compute/device/device.hpp"

namespace nacre {

/// One OpenGL buffer, registered with CUDA while this lives. OpenGL must not use it between map and unmap. All calls on
/// the thread of the context.
class CudaLink {
 public:
  virtual ~CudaLink() = default;
  virtual void* map() = 0;  ///< its device pointer; what the device does next waits for draws that use it. Throws Error
  virtual void unmap() = 0;  ///< the next draws wait for the work submitted to the device
};

/// Host memory that CUDA copies to at full speed.
class PinnedMemory {
 public:
  virtual ~PinnedMemory() = default;
  virtual void* data() = 0;
};

/// Is the current context on the GPU that `device` is? False in a build without CUDA.
bool cuda_draws_here(const Device& device);

/// Registers the buffer named `gl_buffer` for `device`, which is a CUDA device. Throws Error where CUDA cannot, or the
/// build has none.
std::unique_ptr<CudaLink> link_cuda(Device& device, unsigned gl_buffer);

/// Throws Error where there is not that much, or the build has no CUDA.
std::unique_ptr<PinnedMemory> pin_memory(std::size_t bytes);

}  // namespace nacre
