// Nacre: puts images over a frame: legends, stamps, the triad of axes.
#pragma once

#include "engine/gl/buffer.hpp"
#include "engine/gl/shader.hpp"
#include "engine/gl/texture.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// Draws into what is bound, pixel by pixel and over everything. Only tiles with something on them are drawn: most of
/// an overlay is clear, and blending all of a frame costs a software renderer more than the scene.
class OverlayPass {
 public:
  OverlayPass();
  ~OverlayPass();
  OverlayPass(const OverlayPass&) = delete;
  OverlayPass& operator=(const OverlayPass&) = delete;

  /// What is drawn from now on; an image without pixels: nothing. It goes up to the graphics device.
  void set_image(const Image& image);
  /// Puts its right lower corner into that of the picture.
  void draw(const View& view) const;

 private:
  Program program_;
  ImageTexture texture_;
  Buffer tiles_;
  GLsizei tile_count_ = 0;
  GLuint array_ = 0;
};

}  // namespace nacre
