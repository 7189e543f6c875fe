// Nacre: draws marks on a surface whose size is in pixels.
#pragma once

#include <array>
#include <span>

#include "engine/gl/buffer.hpp"
#include "engine/render/view.hpp"

namespace nacre {

enum class MarkShape { disc, ring, diamond };

struct Mark {
  Vec3f position;                 ///< model coordinates
  std::array<float, 3> colour{};  ///< encoded
  float shape = 0;                ///< a MarkShape
};

/// Draws what nothing lies in front of, into what is bound.
class MarkPass {
 public:
  MarkPass();
  ~MarkPass();
  MarkPass(const MarkPass&) = delete;
  MarkPass& operator=(const MarkPass&) = delete;

  /// The marks to draw from now on.
  void set_marks(std::span<const Mark> marks);
  /// `radius`: of a disc, pixels; an outline of 0.3 radii is around it.
  void draw(const View& view, const Placement& placement, float radius, const std::array<float, 3>& outline) const;

 private:
  Program program_;
  Buffer marks_;
  GLuint array_ = 0;
  GLsizei count_ = 0;
};

}  // namespace nacre
