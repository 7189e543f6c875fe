// Nacre: draws an image as a parallelogram in the world.
#include "engine/render/slice_pass.hpp"

namespace nacre {

SlicePass::SlicePass() : program_("slice.vert", "slice.frag") { glCreateVertexArrays(1, &array_); }

SlicePass::~SlicePass() { glDeleteVertexArrays(1, &array_); }

void SlicePass::set_image(const Image& image, bool smooth) {
  texture_ = TextureName();
  if (image.pixels.empty()) return;
  texture_ = TextureName(GL_TEXTURE_2D);
  const GLuint id = texture_.id();
  glTextureStorage2D(id, 1, GL_RGBA8, image.width, image.height);
  glTextureSubImage2D(id, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void SlicePass::set_frame(const Vec3d& corner, const Vec3d& across, const Vec3d& up) {
  const Vec3d third = cross(across, up);  // it has no depth of its own, but the map must be invertible
  const double scale = length(across) / length(third);
  const auto column = [](const Vec3d& v, double w) { return glm::dvec4(v.x, v.y, v.z, w); };
  placement_ = Placement(column(across, 0), column(up, 0), column(third * scale, 0), column(corner, 1));
}

void SlicePass::draw(const View& view) const {
  if (texture_.id() == 0) return;
  set_view(program_, view, placement_);
  glBindTextureUnit(0, texture_.id());
  program_.set("image", 0);
  glBindVertexArray(array_);
  glEnable(GL_DEPTH_TEST);
  program_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace nacre
