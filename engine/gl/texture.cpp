// Nacre: textures.
#include "engine/gl/texture.hpp"

#include <cassert>
#include <utility>

#include "engine/gl/errors.hpp"

namespace nacre {

TextureName& TextureName::operator=(TextureName&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

BufferTexture::BufferTexture(const Buffer& buffer, GLenum format) : name_(GL_TEXTURE_BUFFER) {
  if (buffer) glTextureBuffer(name_.id(), format, buffer.id());
}

std::size_t BufferTexture::most_elements() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return most > 65536 ? std::size_t(most) : 65536;  // the minimum that the standard guarantees
}

ColourTexture::ColourTexture(std::span<const std::array<float, 3>> colours) : name_(GL_TEXTURE_1D) {
  glTextureStorage1D(name_.id(), 1, GL_RGB32F, GLsizei(colours.size()));
  glTextureSubImage1D(name_.id(), 0, 0, GLsizei(colours.size()), GL_RGB, GL_FLOAT, colours.data());
  glTextureParameteri(name_.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name_.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name_.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  require_gl_memory(colours.size_bytes());
}

ImageTexture::ImageTexture(const Image& image) : name_(GL_TEXTURE_2D), width_(image.width), height_(image.height) {
  glTextureStorage2D(name_.id(), 1, GL_RGBA8, width_, height_);
  require_gl_memory(image.pixels.size());
  update(image);
}

void ImageTexture::update(const Image& image) {
  assert(image.width == width_ && image.height == height_);
  glTextureSubImage2D(name_.id(), 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
}

}  // namespace nacre
