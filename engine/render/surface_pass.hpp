// Nacre: draws a surface with the texture of the flow and a colour map.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/gl/texture.hpp"
#include "engine/picture/dye_colours.hpp"
#include "engine/render/geometry.hpp"
#include "engine/render/octree_texture.hpp"
#include "engine/render/sparse_texture.hpp"

namespace nacre {

/// A value per point of the mesh to colour by, and the colours for these values.
class SurfaceColours {
 public:
  /// 256 colours, encoded.
  void set_map(std::span<const std::array<float, 3>> colours);
  /// One number per point. They are input, not results: this is the only array that is uploaded as time advances.
  void set_scalar(std::span<const float> scalar, double low, double high);
  /// Lines of equal value: so many steps over the range; 0: none.
  void set_isolines(int steps) { isolines_ = float(steps); }
  void set_range(double low, double high);  ///< of the colour map
  /// Encoded colours of values beyond the range, and of NaN.
  void set_beyond(const std::array<float, 3>& below, const std::array<float, 3>& above,
                  const std::array<float, 3>& no_number);
  void clear_scalar() { coloured_ = false; }
  /// Dyes over the colours, per point of the mesh; none: no dyes.
  void set_dyes(std::span<const DyeMix> mixes);

  int bind(const Program& program, int unit) const;

 private:
  ColourTexture map_;
  Buffer scalar_;
  BufferTexture scalar_texture_;
  Buffer dye_;
  BufferTexture dye_texture_;
  bool dyed_ = false;
  bool coloured_ = false;
  float low_ = 0, high_ = 1, isolines_ = 0;
  std::array<float, 3> below_{}, above_{}, no_number_{0.25f, 0.25f, 0.25f};  ///< as the shader sees them
};

/// What a texture's look-up does not say: how many values there are if means of blocks follow them (-1: none do), and
/// how far from the points of a second sheet its values are found, in world units.
struct TextureLayout {
  std::int64_t values = -1;
  Vec3d sheet_shift{};
};

/// How a part of a surface is laid over what was drawn before.
struct SurfaceOver {
  float opacity = 1;
  float nearer = 0;  ///< by so many least steps of the depth
};

/// How shown values are looked up.
using SurfaceTexture = std::variant<SparseTexture, OctreeTexture>;

/// Draws into what is bound. Without a texture the surface is plain.
class SurfacePass {
 public:
  SurfacePass() : plain_("surface.vert", "surface.frag") {}

  /// From now on looks values up in `texture`; an empty one leaves the surface plain.
  void set_texture(SurfaceTexture texture, const TextureLayout& layout = {});
  bool textured() const {
    return std::visit([](const auto& texture) { return bool(texture); }, texture_);
  }

  /// `shown`: one value per surface cell, and the means that the layout says; null: plain. Of two sheets in one place
  /// the one that faces the camera is seen.
  void draw(const View& view, const SurfaceBuffers& surface, const SurfaceColours& colours, const BufferTexture* shown,
            BackFaces back_faces = BackFaces::shown, const SurfaceOver& over = {}) const;

 private:
  Program plain_, textured_;
  SurfaceTexture texture_;
  TextureLayout layout_;
};

}  // namespace nacre
