// Nacre: draws vectors as arrows on a surface.
#pragma once

#include <array>
#include <span>

#include "engine/gl/buffer.hpp"
#include "engine/gl/texture.hpp"
#include "engine/render/view.hpp"

namespace nacre {

struct Arrow {
  Vec3f position;   ///< of its tail, in model coordinates
  Vec3f vector;     ///< from tail to tip, in world coordinates
  Vec3f normal;     ///< of the surface, unit
  float shade = 0;  ///< 0..1, position in the colour map
};

struct ArrowStyle {
  float scale = 1;                              ///< of the vectors
  float width = 1;                              ///< of the head, world units; short arrows are thinner
  std::array<float, 3> ink{0.1f, 0.1f, 0.12f};  ///< encoded
  bool mapped = false;                          ///< coloured by `shade` instead
};

/// Draws solid arrows that lie on the surface, into what is bound.
class ArrowPass {
 public:
  ArrowPass();
  ~ArrowPass();
  ArrowPass(const ArrowPass&) = delete;
  ArrowPass& operator=(const ArrowPass&) = delete;

  /// 256 colours, encoded.
  void set_map(std::span<const std::array<float, 3>> colours);
  /// The arrows to draw from now on.
  void set_arrows(std::span<const Arrow> arrows);
  void draw(const View& view, const Placement& placement, const ArrowStyle& style) const;

 private:
  Program program_;
  ColourTexture map_;
  Buffer arrows_;
  GLuint array_ = 0;
  GLsizei count_ = 0;
};

}  // namespace nacre
