// Nacre: the small triad of axes in the corner of a frame.
#pragma once

#include "engine/gl/buffer.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// Draws x, y and z as arrows with their letters, in the right lower corner, over everything.
class AxesPass {
 public:
  AxesPass();
  ~AxesPass();
  AxesPass(const AxesPass&) = delete;
  AxesPass& operator=(const AxesPass&) = delete;

  /// `scale`: pixels of this screen to one of an ordinary screen; nothing is drawn where the frame is too small for it.
  void draw(const View& view, float scale = 1);

 private:
  Program program_;
  Buffer corners_;
  GLuint array_ = 0;
};

}  // namespace nacre
