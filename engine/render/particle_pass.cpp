// Nacre: draws particles.
#include "engine/render/particle_pass.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nacre {

ParticlePass::ParticlePass() : program_("particles.vert", "particles.frag") {
  glCreateVertexArrays(1, &array_);
  for (GLuint k = 0; k < 2; ++k) {
    glEnableVertexArrayAttrib(array_, k);
    glVertexArrayAttribFormat(array_, k, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array_, k, k);
    glVertexArrayBindingDivisor(array_, k, 1);
  }
}

ParticlePass::~ParticlePass() { glDeleteVertexArrays(1, &array_); }

void ParticlePass::set_map(std::span<const std::array<float, 3>> colours) {
  std::vector<std::array<float, 3>> linear(colours.begin(), colours.end());
  for (auto& colour : linear)
    for (float& c : colour) c *= c;
  map_ = ColourTexture(linear);
}

namespace {
constexpr std::size_t most_skipped = 128;  // OpenGL promises steps of 2048 bytes from one instance to the next
}

std::size_t particle_share(const View& view, std::size_t count, double diameter) {
  constexpr double pixels_each = 3;
  const double seen = diameter > 0 ? std::min(1.0, std::pow(view.camera.height / (0.5 * diameter), 2)) : 1;
  const double room = double(view.width) * double(view.height) / pixels_each;
  return std::clamp<std::size_t>(std::size_t(double(count) * seen / std::max(room, 1.0)), 1, most_skipped);
}

void ParticlePass::draw(const View& view, const Placement& placement, const Buffer& position, const Buffer& direction,
                        std::size_t first, std::size_t count, const ParticleStyle& style) const {
  if (count == 0 || !position || !direction) return;
  constexpr std::size_t record = 4 * sizeof(float);
  set_view(program_, view, placement);
  const std::size_t every = std::max<std::size_t>(1, style.every);
  program_.set("size", style.size * std::sqrt(float(every)));
  program_.set("face_camera", style.face_camera ? 1 : 0);
  program_.set("by_energy", style.by_energy ? 1 : 0);
  program_.set("range", style.range);
  map_.bind(0);
  program_.set("colours", 0);
  const auto step = GLsizei(every * record);
  glVertexArrayVertexBuffer(array_, 0, position.id(), GLintptr(first * record), step);
  glVertexArrayVertexBuffer(array_, 1, direction.id(), GLintptr(first * record), step);
  glBindVertexArray(array_);
  glEnable(GL_DEPTH_TEST);
  program_.use();
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei((count + every - 1) / every));
}

}  // namespace nacre
