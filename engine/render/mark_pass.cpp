// Nacre: draws marks on a surface whose size is in pixels.
#include "engine/render/mark_pass.hpp"

#include <cstddef>

#include "engine/render/blended.hpp"
namespace nacre {

MarkPass::MarkPass() : program_("marks.vert", "marks.frag") {
  glCreateVertexArrays(1, &array_);
  const auto attribute = [&](GLuint k, GLint components, std::size_t offset) {
    glEnableVertexArrayAttrib(array_, k);
    glVertexArrayAttribFormat(array_, k, components, GL_FLOAT, GL_FALSE, GLuint(offset));
    glVertexArrayAttribBinding(array_, k, 0);
  };
  attribute(0, 3, offsetof(Mark, position));
  attribute(1, 4, offsetof(Mark, colour));  // and the shape behind it
  glVertexArrayBindingDivisor(array_, 0, 1);
}

MarkPass::~MarkPass() { glDeleteVertexArrays(1, &array_); }

void MarkPass::set_marks(std::span<const Mark> marks) {
  count_ = GLsizei(marks.size());
  marks_ = marks.empty() ? Buffer() : Buffer::of<Mark>(marks);
}

void MarkPass::draw(const View& view, const Placement& placement, float radius,
                    const std::array<float, 3>& outline) const {
  if (count_ == 0) return;
  set_view(program_, view, placement);
  program_.set("radius", 1.3f * radius);
  program_.set("outline", outline);
  program_.set("lift", lift_of(view));
  program_.use();
  glVertexArrayVertexBuffer(array_, 0, marks_.id(), 0, sizeof(Mark));
  glBindVertexArray(array_);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  const Blended blended;
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
  glDepthMask(GL_TRUE);
}

}  // namespace nacre
