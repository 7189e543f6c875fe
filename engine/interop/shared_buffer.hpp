// Nacre: an array that compute writes directly and OpenGL draws from. Only this folder knows both.
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
/// the thread of the context; only the memory from `begin_write` is passed to the thread that computes.
///
///   void* memory = buffer.begin_write();  // device memory; null while frames still read it: try at the next frame
///   ... compute writes all of it, on any thread; frames go on ...
///   buffer.end_write();                   // from now on frames show it
class SharedBuffer {
 public:
  enum class Path {
    mapped,      ///< CPU: the buffers stay mapped in host memory
    registered,  ///< CUDA on the GPU that draws: a buffer belongs to CUDA between begin_write and end_write
    copied       ///< neither: copied through pinned host memory at every end_write
  };

  /// The path that suits the device and the current context.
  static Path best_path(const Device& device);

  /// `format`: how shaders see it as a texture, e.g. GL_R32F. The first frames read zeros. Throws Error if memory is
  /// insufficient, or if the device does not support the path.
  SharedBuffer(Device& device, std::size_t bytes, GLenum format, Path path);
  SharedBuffer(Device& device, std::size_t bytes, GLenum format)
      : SharedBuffer(device, bytes, format, best_path(device)) {}
  ~SharedBuffer();
  SharedBuffer(const SharedBuffer&) = delete;
  SharedBuffer& operator=(const SharedBuffer&) = delete;

  /// Memory of the device that no frame reads; its previous contents are lost. Null while the graphics device may still
  /// read it, unless `wait` is set.
  void* begin_write(bool wait = false);
  /// Compute has finished writing. Does nothing if no write was begun.
  void end_write();
  /// Compute has been interrupted: what it wrote is discarded.
  void cancel_write();
  bool writing() const { return writing_; }

  const Buffer& shown() const { return halves_[shown_].buffer; }
  const BufferTexture& texture() const { return halves_[shown_].texture; }
  /// The draws so far read what is shown; it is not overwritten before they are done.
  void drawn();

  std::size_t bytes() const { return bytes_; }
  Path path() const { return path_; }
  std::uint64_t copied_bytes() const { return copied_; }  ///< between devices so far; 0 if nothing is copied
  /// Why it copies, as a sentence for the user; empty if it does not.
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
  void* staging_ = nullptr;               ///< on the device, if it copies
  std::unique_ptr<PinnedMemory> pinned_;  ///< on the host, the destination of copies from CUDA
  std::uint64_t copied_ = 0;
};

}  // namespace nacre
