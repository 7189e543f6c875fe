// Nacre: draws line segments that are wider than a pixel.
#pragma once

#include <array>
#include <span>

#include "engine/gl/buffer.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// Two end points, in model coordinates.
struct LineSegment {
  Vec3f from, to;
};

struct LineStyle {
  std::array<float, 4> colour{0, 0, 0, 1};  ///< encoded, with opacity
  float width = 2;                          ///< pixels
  bool through = false;                     ///< also drawn where something is in front of them
};

/// Segments on the graphics device, drawn into what is bound.
class SegmentPass {
 public:
  SegmentPass();
  ~SegmentPass();
  SegmentPass(const SegmentPass&) = delete;
  SegmentPass& operator=(const SegmentPass&) = delete;

  void draw(const View& view, const Placement& placement, const Buffer& segments, const LineStyle& style) const;

 private:
  Program program_;
  GLuint array_ = 0;
};

}  // namespace nacre
