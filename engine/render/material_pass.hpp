// Nacre: draws the triangles between materials: solid, as ghosts, or not at all.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/gl/buffer.hpp"
#include "engine/gl/texture.hpp"
#include "engine/render/geometry.hpp"

namespace nacre {

/// How a material looks.
struct MaterialLook {
  std::array<float, 3> colour{0.6f, 0.6f, 0.6f};  ///< encoded
  float opacity = 1;                              ///< 1 solid, between: a ghost, 0 hidden
};

/// Draws into what is bound. The surface was made without normals: triangles are flat.
class MaterialPass {
 public:
  MaterialPass() : program_("materials.vert", "materials.frag") {}

  /// The two materials of each triangle, in the order of the geometry.
  void set_materials(std::span<const std::array<std::uint16_t, 2>> materials);
  /// One per material; number 0 is the outside. A triangle is as visible as the more visible of its two materials.
  void set_looks(std::span<const MaterialLook> looks);

  /// `placement`: of the mesh's coordinates in the world. Ghosts are drawn last, and do not hide what is behind them.
  void draw(const View& view, const SurfaceBuffers& surface, const Placement& placement) const;

 private:
  Program program_;
  Buffer materials_, looks_;
  BufferTexture materials_texture_, looks_texture_;
  bool ghosts_ = false;
};

}  // namespace nacre
