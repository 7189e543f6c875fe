// Nacre: draws particles as discs that lie on their surface.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/gl/buffer.hpp"
#include "engine/gl/texture.hpp"
#include "engine/render/view.hpp"

namespace nacre {

struct ParticleStyle {
  float size = 0.36f;                ///< radius of a disc, in h
  bool face_camera = false;          ///< particles of curves and points have no normal
  bool by_energy = true;             ///< colour by energy, else by h
  std::array<float, 2> range{0, 1};  ///< of the colour map
  std::size_t every = 1;             ///< n: only every n-th is drawn, with n times the area
};

/// ParticleStyle::every for `count` particles on surfaces of that diameter (world): more than a third as many as pixels
/// would each cover less than a few of these, and cost a software renderer a second a frame.
std::size_t particle_share(const View& view, std::size_t count, double diameter);

/// Draws directly from the arrays of the solver (ParticleSet): `position` x, y, z, h; `direction` nx, ny, nz, energy.
class ParticlePass {
 public:
  ParticlePass();
  ~ParticlePass();
  ParticlePass(const ParticlePass&) = delete;
  ParticlePass& operator=(const ParticlePass&) = delete;

  /// 256 colours, encoded.
  void set_map(std::span<const std::array<float, 3>> colours);

  /// Draws particles first .. first + count - 1, or a share of them, into what is bound.
  void draw(const View& view, const Placement& placement, const Buffer& position, const Buffer& direction,
            std::size_t first, std::size_t count, const ParticleStyle& style) const;

 private:
  Program program_;
  ColourTexture map_;
  GLuint array_ = 0;
};

}  // namespace nacre
