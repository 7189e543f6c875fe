// Nacre: textures, and buffers that a shader reads as textures.
#pragma once

#include <GL/glew.h>

#include <array>
#include <cstddef>
#include <span>

#include "engine/gl/buffer.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// The name of a texture, deleted with its owner.
class TextureName {
 public:
  TextureName() = default;
  explicit TextureName(GLenum target) { glCreateTextures(target, 1, &id_); }
  ~TextureName() {
    if (id_) glDeleteTextures(1, &id_);
  }
  TextureName(TextureName&& other) noexcept : id_(other.id_) { other.id_ = 0; }
  TextureName& operator=(TextureName&& other) noexcept;

  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

/// A buffer as elements of `format` (e.g. GL_R32F), for samplerBuffer and texelFetch. It does not own the buffer.
class BufferTexture {
 public:
  BufferTexture() = default;
  BufferTexture(const Buffer& buffer, GLenum format);

  void bind(int unit) const { glBindTextureUnit(GLuint(unit), name_.id()); }

  /// The largest number of elements that a texture can have here; a larger array is divided into pages.
  static std::size_t most_elements();

 private:
  TextureName name_;
};

/// Colours along a line, linear in between: colour k of n at (k + 0.5) / n.
class ColourTexture {
 public:
  ColourTexture() = default;
  /// RGB as the shader is to see it.
  explicit ColourTexture(std::span<const std::array<float, 3>> colours);

  void bind(int unit) const { glBindTextureUnit(GLuint(unit), name_.id()); }

 private:
  TextureName name_;
};

/// An image as a texture for texelFetch; row 0 is the first row of the image.
class ImageTexture {
 public:
  ImageTexture() = default;
  explicit ImageTexture(const Image& image);

  void bind(int unit) const { glBindTextureUnit(GLuint(unit), name_.id()); }
  GLuint id() const { return name_.id(); }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Replaces the pixels by those of an image of the same size.
  void update(const Image& image);

 private:
  TextureName name_;
  int width_ = 0, height_ = 0;
};

}  // namespace nacre
