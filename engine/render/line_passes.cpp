// Nacre: draws lines over a scene.
#include "engine/render/line_passes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>

#include "engine/render/blended.hpp"
namespace nacre {
namespace {

/// Lines of one colour, blended over the picture, into what is bound.
template <class Draw>
void draw_lines(const Program& program, std::array<float, 4> colour, const Draw& draw) {
  program.set("colour", colour);
  program.use();
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  const Blended blended;
  draw();
  glDepthMask(GL_TRUE);
}

}  // namespace

void EdgePass::draw(const View& view, const SurfaceBuffers& surface, const Placement& placement,
                    const std::array<float, 4>& colour) const {
  const double unit = std::cbrt(std::abs(glm::determinant(glm::dmat3(placement))));
  const double pixels = surface.mean_edge() * unit * view.height / view.camera.height;
  const float fade = float(std::clamp((pixels - 2.5) / 6, 0.0, 1.0));
  if (fade <= 0) return;
  set_view(program_, view, placement * surface.placement());
  program_.set("lift", view.camera.orthographic ? 1e-5f : 5e-4f);
  draw_lines(program_, {colour[0], colour[1], colour[2], colour[3] * fade}, [&] { surface.draw_edges(); });
}

BoxPass::BoxPass() : corners_("boxes.vert", "lines.frag"), codes_("boxes.vert", "lines.frag", "#define MORTON") {
  glCreateVertexArrays(1, &corner_array_);
  glCreateVertexArrays(1, &code_array_);
  glEnableVertexArrayAttrib(code_array_, 0);
  glVertexArrayAttribIFormat(code_array_, 0, 2, GL_UNSIGNED_INT, 0);
  for (GLuint k = 0; k < 2; ++k) {
    glEnableVertexArrayAttrib(corner_array_, k);
    glVertexArrayAttribBinding(corner_array_, k, 0);
  }
  glVertexArrayBindingDivisor(corner_array_, 0, 1);
  glVertexArrayBindingDivisor(code_array_, 0, 1);
}

BoxPass::~BoxPass() {
  glDeleteVertexArrays(1, &corner_array_);
  glDeleteVertexArrays(1, &code_array_);
}

void BoxPass::draw_corners(const View& view, const Placement& placement, const Buffer& boxes, const BoxLayout& layout,
                           std::size_t first, std::size_t count, const std::array<float, 4>& colour) const {
  if (count == 0 || !boxes) return;
  set_view(corners_, view, placement);
  glVertexArrayVertexBuffer(corner_array_, 0, boxes.id(), GLintptr(first * layout.stride), GLsizei(layout.stride));
  glVertexArrayAttribFormat(corner_array_, 0, 3, GL_FLOAT, GL_FALSE, GLuint(layout.low));
  glVertexArrayAttribFormat(corner_array_, 1, 3, GL_FLOAT, GL_FALSE, GLuint(layout.high));
  glBindVertexArray(corner_array_);
  draw_lines(corners_, colour, [&] { glDrawArraysInstanced(GL_LINES, 0, 24, GLsizei(count)); });
}

void BoxPass::draw_codes(const View& view, const Placement& placement, const Buffer& codes, std::size_t first,
                         std::size_t count, float width, const std::array<float, 4>& colour) const {
  if (count == 0 || !codes) return;
  set_view(codes_, view, placement);
  codes_.set("width", width);
  glVertexArrayVertexBuffer(code_array_, 0, codes.id(), GLintptr(first * 8), 8);
  glBindVertexArray(code_array_);
  draw_lines(codes_, colour, [&] { glDrawArraysInstanced(GL_LINES, 0, 24, GLsizei(count)); });
}

}  // namespace nacre
