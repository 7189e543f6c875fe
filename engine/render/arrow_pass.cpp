// Nacre: draws vectors as arrows.
#include "engine/render/arrow_pass.hpp"

#include <cstddef>
#include <vector>

namespace nacre {
namespace {

constexpr GLsizei sides = 6, corners_of_side = 9;  // as shaders/arrows.vert makes them: two triangles and one

}  // namespace

ArrowPass::ArrowPass() : program_("arrows.vert", "arrows.frag") {
  glCreateVertexArrays(1, &array_);
  const auto attribute = [&](GLuint number, GLint size, std::size_t offset) {
    glEnableVertexArrayAttrib(array_, number);
    glVertexArrayAttribFormat(array_, number, size, GL_FLOAT, GL_FALSE, GLuint(offset));
    glVertexArrayAttribBinding(array_, number, 0);
  };
  attribute(0, 3, offsetof(Arrow, position));
  attribute(1, 3, offsetof(Arrow, vector));
  attribute(2, 3, offsetof(Arrow, normal));
  attribute(3, 1, offsetof(Arrow, shade));
  glVertexArrayBindingDivisor(array_, 0, 1);
}

ArrowPass::~ArrowPass() { glDeleteVertexArrays(1, &array_); }

void ArrowPass::set_map(std::span<const std::array<float, 3>> colours) { map_ = ColourTexture(colours); }

void ArrowPass::set_arrows(std::span<const Arrow> arrows) {
  count_ = GLsizei(arrows.size());
  if (arrows.empty()) return;
  if (arrows_.bytes() != arrows.size_bytes()) {
    arrows_ = Buffer(arrows.size_bytes());
    glVertexArrayVertexBuffer(array_, 0, arrows_.id(), 0, sizeof(Arrow));
  }
  arrows_.update(arrows);
}

void ArrowPass::draw(const View& view, const Placement& placement, const ArrowStyle& style) const {
  if (count_ == 0) return;
  set_view(program_, view, placement);
  program_.set("scale", style.scale);
  program_.set("width", style.width);
  program_.set("ink", style.ink);
  program_.set("mapped", style.mapped ? 1 : 0);
  map_.bind(0);
  program_.set("colours", 0);
  glBindVertexArray(array_);
  glEnable(GL_DEPTH_TEST);
  program_.use();
  glDrawArraysInstanced(GL_TRIANGLES, 0, sides * corners_of_side, count_);
}

}  // namespace nacre
