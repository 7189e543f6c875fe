// Nacre: draws lines over a scene: edges of triangles, boxes of trees.
#pragma once

#include <array>
#include <cstddef>

#include "engine/gl/shader.hpp"
#include "engine/render/geometry.hpp"

namespace nacre {

/// Draws each edge of a surface once, slightly in front of its triangles.
class EdgePass {
 public:
  EdgePass() : program_("edges.vert", "lines.frag") {}

  /// `colour`: encoded, with opacity. Lines fade where triangles are only some pixels large.
  void draw(const View& view, const SurfaceBuffers& surface, const Placement& placement,
            const std::array<float, 4>& colour) const;

 private:
  Program program_;
};

/// Byte offsets of the corners of a box in the records of a buffer; corners are floats.
struct BoxLayout {
  std::size_t stride, low, high;  ///< bytes
};

/// Draws boxes directly from the buffers that the build of a tree has written.
class BoxPass {
 public:
  BoxPass();
  ~BoxPass();
  BoxPass(const BoxPass&) = delete;
  BoxPass& operator=(const BoxPass&) = delete;

  /// `count` records with two corners each, from record `first` on.
  void draw_corners(const View& view, const Placement& placement, const Buffer& boxes, const BoxLayout& layout,
                    std::size_t first, std::size_t count, const std::array<float, 4>& colour) const;
  /// `count` Morton codes (64 bits) of cubes of edge `width` in the model's units.
  void draw_codes(const View& view, const Placement& placement, const Buffer& codes, std::size_t first,
                  std::size_t count, float width, const std::array<float, 4>& colour) const;

 private:
  Program corners_, codes_;
  GLuint corner_array_ = 0, code_array_ = 0;
};

}  // namespace nacre
