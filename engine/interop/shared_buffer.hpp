// Nacre: an array that compute writes straight into and OpenGL draws from. The one place that knows both.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "compute/device/device.hpp"
#include "engine/gl/buffer.hpp"
#include "engine/gl/texture.hpp"
#include "engine/interop/cuda_link.hpp"

namespace nacre {

/// Two OpenGL buffers of the same size: frames are drawn from one while compute fills the other. All calls are made on
/// the thread of the context; only the memory that `begin_write` gives goes to the thread that computes.
///
///   void* memory = buffer.begin_write();  // device memory; null while frames still read it: try at the next frame
///   ... compute writes all of it, on any thread; frames go on ...
///   buffer.end_write();                   // from now on frames show it
class SharedBuffer {
 public:
  enum class Path {
    mapped,      ///< CPU: the buffers lie in host memory for good
    registered,  ///< CUDA draws on the same GPU: a buffer is CUDA's between begin_write and end_write
    copied       ///< neither: through pinned host memory at every end_write
  };

  /// What suits the device and the context that is current.
  static Path best_path(const Device& device);

  /// `format`: how shaders see it as a texture, e.g. GL_R32F. The first frames read zeros. Throws Error where the
  /// memory is not there, or the device cannot go the path.
  SharedBuffer(Device& device, std::size_t bytes, GLenum format, Path path);
  SharedBuffer(Device& device, std::size_t bytes, GLenum format)
      : SharedBuffer(device, bytes, format, best_path(device)) {}
  ~SharedBuffer();
  SharedBuffer(const SharedBuffer&) = delete;
  SharedBuffer& operator=(const SharedBuffer&) = delete;

  /// Memory of the device that no frame reads; what was in it before is lost. Null while the graphics device may still
  /// read it, unless told to `wait`.
  void* begin_write(bool wait = false);
  /// Compute is done with it. Does nothing where nothing was begun.
  void end_write();
  /// Compute has been interrupted: what it wrote is dropped.
  void cancel_write();
  bool writing() const { return writing_; }

  const Buffer& shown() const { return halves_[shown_].buffer; }
  const BufferTexture& texture() const { return halves_[shown_].texture; }
  /// The draws so far read what is shown: it is not written before they are done.
  void drawn();

  std::size_t bytes() const { return bytes_; }
  Path path() const { return path_; }
  std::uint64_t copied_bytes() const { return copied_; }  ///< across since the start; 0 where nothing has to be copied
  /// Why it copies, as a sentence for the user; empty where it does not.
  std::string remark() const;

 private:
  struct Half {
    Buffer buffer;
    BufferTexture texture;
    void* mapped = nullptr;
    std::unique_ptr<CudaLink> link;
    GLsync fence = nullptr;

    Half() = default;
    ~Half();
    Half(const Half&) = delete;
    Half& operator=(const Half&) = delete;
  };

  void make_staging();
  bool is_free(Half& half, bool wait);

  Device& device_;
  std::size_t bytes_;
  Path path_;
  std::array<Half, 2> halves_;
  int shown_ = 0;
  bool writing_ = false;
  void* staging_ = nullptr;               ///< on the device, where it copies
  std::unique_ptr<PinnedMemory> pinned_;  ///< on the host, where it copies from CUDA
  std::uint64_t copied_ = 0;
};

}  // namespace nacre
