// Nacre: the target of all drawing, separate from the window.
#pragma once

#include <GL/glew.h>

#include <array>
#include <memory>

#include "engine/gl/texture.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// Colour (RGBA, 8 bits, encoded by the shaders) and floating-point depth; with `samples` > 1 edges are antialiased.
/// Throws Error if width or height is not in 1..most_size() or memory is insufficient.
class Framebuffer {
 public:
  Framebuffer(int width, int height, int samples = 1);
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }  ///< at most what was requested, less if the driver cannot do it

  /// From now on everything is drawn into all of it.
  void bind() const;
  /// From now on everything is drawn into a part of it; (0, 0) is the lower left corner.
  void bind_part(int x, int y, int width, int height) const;
  /// Sets all of it to one colour, encoded, and the depth to far away.
  void clear(const std::array<float, 4>& colour) const;
  /// Copies the picture into the lower left corner of the window. From now on everything is drawn into the window.
  void show_in_window() const;
  /// The picture; row 0 at the top. Waits until it is drawn.
  Image read() const;

  static int most_size();

 private:
  GLuint resolved() const;

  int width_, height_, samples_;
  struct Names {
    GLuint frame = 0, colour = 0, depth = 0;
    ~Names();
  } names_;
  std::unique_ptr<Framebuffer> single_;  ///< the samples resolved
};

}  // namespace nacre
