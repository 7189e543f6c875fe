// Nacre: memory of OpenGL.
#include "engine/gl/buffer.hpp"

#include <cassert>
#include <utility>

#include "engine/gl/errors.hpp"

namespace nacre {

void require_gl_memory(std::size_t bytes) {
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError())
    if (error == GL_OUT_OF_MEMORY)
      throw Error("not enough memory on the graphics device", std::to_string(bytes >> 20) + " MiB asked",
                  "lower --resolution");
}

Buffer::Buffer(std::size_t bytes, GLbitfield flags) : Buffer() {
  if (bytes == 0) return;
  bytes_ = bytes;
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, GLsizeiptr(bytes), nullptr, flags);
  require_gl_memory(bytes);
}

Buffer::Buffer(const void* host, std::size_t bytes) : Buffer() {
  if (bytes == 0) return;
  bytes_ = bytes;
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, GLsizeiptr(bytes), host, 0);
  require_gl_memory(bytes);
}

Buffer::~Buffer() {
  if (id_) glDeleteBuffers(1, &id_);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void Buffer::write(const void* host, std::size_t bytes) {
  assert(bytes <= bytes_);
  if (bytes) glNamedBufferSubData(id_, 0, GLsizeiptr(bytes), host);
}

void* Buffer::map(GLbitfield flags) {
  if (!id_) return nullptr;
  void* memory = glMapNamedBufferRange(id_, 0, GLsizeiptr(bytes_), flags);
  require_gl_memory(bytes_);
  if (!memory) throw Error("the graphics driver cannot map a buffer", std::to_string(bytes_ >> 20) + " MiB");
  return memory;
}

}  // namespace nacre
