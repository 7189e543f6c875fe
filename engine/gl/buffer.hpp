// Nacre: memory of OpenGL.
#pragma once

#include <GL/glew.h>

#include <cstddef>
#include <span>
#include <type_traits>

namespace nacre {

/// An OpenGL buffer of fixed size. Throws Error if memory is insufficient.
class Buffer {
 public:
  Buffer() = default;
  /// `bytes` that are not initialised (a buffer of size 0 has no name). `flags`: of glNamedBufferStorage.
  explicit Buffer(std::size_t bytes, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
  ~Buffer();
  Buffer(Buffer&& other) noexcept { *this = static_cast<Buffer&&>(other); }
  Buffer& operator=(Buffer&& other) noexcept;

  /// A buffer that contains a copy of `host`.
  template <class T>
  static Buffer of(std::span<const T> host) {
    static_assert(std::is_trivially_copyable_v<T>);
    return Buffer(host.data(), host.size_bytes());
  }

  GLuint id() const { return id_; }
  std::size_t bytes() const { return bytes_; }
  explicit operator bool() const { return id_ != 0; }

  /// Writes `host` at the start; at most `bytes()`.
  template <class T>
  void update(std::span<const T> host) {
    static_assert(std::is_trivially_copyable_v<T>);
    write(host.data(), host.size_bytes());
  }

  /// All of the buffer as host memory, until it is destroyed. It must have been made with these flags and
  /// GL_MAP_PERSISTENT_BIT.
  void* map(GLbitfield flags);

 private:
  Buffer(const void* host, std::size_t bytes);
  void write(const void* host, std::size_t bytes);

  GLuint id_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace nacre
