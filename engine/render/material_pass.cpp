// Nacre: draws the triangles between materials.
#include "engine/render/material_pass.hpp"

#include <algorithm>
#include <vector>

#include "engine/render/blended.hpp"
namespace nacre {

void MaterialPass::set_materials(std::span<const std::array<std::uint16_t, 2>> materials) {
  std::vector<std::uint32_t> packed;
  packed.reserve(materials.size());
  for (const auto& pair : materials) packed.push_back(pair[0] | std::uint32_t(pair[1]) << 16);
  materials_ = Buffer::of<std::uint32_t>(packed);
  materials_texture_ = BufferTexture(materials_, GL_R32UI);
}

void MaterialPass::set_styles(std::span<const MaterialStyle> styles) {
  styles_ = Buffer::of<MaterialStyle>(styles);
  styles_texture_ = BufferTexture(styles_, GL_RGBA32F);
  ghosts_ = std::any_of(styles.begin(), styles.end(),
                        [](const MaterialStyle& style) { return style.opacity > 0 && style.opacity < 1; });
}

void MaterialPass::draw(const View& view, const SurfaceBuffers& surface, const Placement& placement) const {
  set_view(program_, view, placement * surface.placement());
  materials_texture_.bind(0);
  program_.set("materials", 0);
  styles_texture_.bind(1);
  program_.set("material_colour", 1);
  program_.set("ghosts", 0);
  glEnable(GL_DEPTH_TEST);
  program_.use();
  surface.draw_triangles();
  if (!ghosts_) return;
  program_.set("ghosts", 1);
  const Blended blended;
  glDepthMask(GL_FALSE);
  surface.draw_triangles();
  glDepthMask(GL_TRUE);
}

}  // namespace nacre
