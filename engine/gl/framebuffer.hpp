// Nacre: what is drawn into, apart from the window.
#pragma once

#include <GL/glew.h>

#include <array>
#include <memory>

#include "engine/gl/texture.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// Colour (RGBA, 8 bits, encoded by the shaders) and floating-point depth; with `samples` > 1 edges are smooth. Throws
/// Error where width or height is not in 1..most_size() or the memory is not there.
class Framebuffer {
 public:
  Framebuffer(int width, int height, int samples = 1);
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }  ///< what the driver can do, at most what was asked

  /// Draws go here from now on, to all of it.
  void bind() const;
  /// Draws go to a part of it from now on; (0, 0) is the left lower corner.
  void bind_part(int x, int y, int width, int height) const;
  /// All of it to one colour, encoded; depth to far away.
  void clear(const std::array<float, 4>& colour) const;
  /// Puts the picture into the left lower corner of the window. Draws go to the window from now on.
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
  std::unique_ptr<Framebuffer> single_;  ///< samples put together
};

}  // namespace nacre
