// Nacre: draws line segments that are wider than a pixel.
#include "engine/render/segment_pass.hpp"

#include <cstddef>

#include "engine/render/blended.hpp"
namespace nacre {

SegmentPass::SegmentPass() : program_("segments.vert", "lines.frag") {
  glCreateVertexArrays(1, &array_);
  for (GLuint k = 0; k < 2; ++k) {
    glEnableVertexArrayAttrib(array_, k);
    glVertexArrayAttribFormat(array_, k, 3, GL_FLOAT, GL_FALSE,
                              k == 0 ? offsetof(LineSegment, from) : offsetof(LineSegment, to));
    glVertexArrayAttribBinding(array_, k, 0);
  }
  glVertexArrayBindingDivisor(array_, 0, 1);
}

SegmentPass::~SegmentPass() { glDeleteVertexArrays(1, &array_); }

void SegmentPass::draw(const View& view, const Placement& placement, const Buffer& segments,
                       const LineStyle& style) const {
  if (!segments) return;
  set_view(program_, view, placement);
  program_.set("colour", style.colour);
  program_.set("width", style.width);
  program_.set("lift", lift_of(view));
  program_.use();
  glVertexArrayVertexBuffer(array_, 0, segments.id(), 0, sizeof(LineSegment));
  glBindVertexArray(array_);
  if (style.through)
    glDisable(GL_DEPTH_TEST);
  else
    glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  const Blended blended;
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(segments.bytes() / sizeof(LineSegment)));
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace nacre
