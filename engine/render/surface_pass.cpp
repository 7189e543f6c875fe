// Nacre: draws a surface.
#include "engine/render/surface_pass.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/render/blended.hpp"
namespace nacre {
namespace {

/// Depths are larger where they are nearer.
void set_nearer(float steps) {
  if (steps == 0) return glDisable(GL_POLYGON_OFFSET_FILL);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(0.25f * steps, steps);
}

/// Triangles that face the camera, and those that do not; the former lie before the latter where both are in one place.
void draw_sides(const Program& program, const SurfaceBuffers& surface, bool one_sided, BackFaces back_faces,
                float nearer) {
  program.set("neutral", 0);
  const bool alike = !one_sided && !surface.sheets() && back_faces == BackFaces::shown;
  if (!alike) glEnable(GL_CULL_FACE);
  set_nearer(nearer);
  surface.draw_triangles();
  if (!alike && !one_sided && back_faces != BackFaces::hidden) {
    program.set("neutral", back_faces == BackFaces::neutral ? 1 : 0);
    glCullFace(GL_FRONT);
    set_nearer(nearer - 2);
    surface.draw_triangles();
    glCullFace(GL_BACK);
  }
  set_nearer(0);
  glDisable(GL_CULL_FACE);
}

}  // namespace

void SurfaceColours::set_map(std::span<const std::array<float, 3>> colours) {
  std::vector<std::array<float, 3>> linear(colours.begin(), colours.end());
  for (auto& colour : linear)
    for (float& c : colour) c *= c;  // gamma 2, as in pictures without OpenGL
  map_ = ColourTexture(linear);
  below_ = linear.front();
  above_ = linear.back();
}

void SurfaceColours::set_beyond(const std::array<float, 3>& below, const std::array<float, 3>& above,
                                const std::array<float, 3>& no_number) {
  const auto squared = [](std::array<float, 3> colour) {
    for (float& c : colour) c *= c;
    return colour;
  };
  below_ = squared(below);
  above_ = squared(above);
  no_number_ = squared(no_number);
}

void SurfaceColours::set_range(double low, double high) {
  low_ = float(low);
  high_ = high > low ? float(high) : std::nextafter(low_, 1e30f);
}

void SurfaceColours::set_scalar(std::span<const float> scalar, double low, double high) {
  if (scalar_.bytes() != scalar.size_bytes() || !scalar_) {
    scalar_ = Buffer(scalar.size_bytes());
    scalar_texture_ = BufferTexture(scalar_, GL_R32F);
  }
  scalar_.update(scalar);
  set_range(low, high);
  coloured_ = !scalar.empty();
}

void SurfaceColours::set_dyes(std::span<const DyeMix> mixes) {
  dyed_ = !mixes.empty();
  if (!dyed_) return;
  if (dye_.bytes() != mixes.size_bytes() || !dye_) {
    dye_ = Buffer(mixes.size_bytes());
    dye_texture_ = BufferTexture(dye_, GL_RGBA32F);
  }
  dye_.update(mixes);
}

int SurfaceColours::bind(const Program& program, int unit) const {
  map_.bind(unit);
  program.set("colours", unit);
  scalar_texture_.bind(unit + 1);
  program.set("scalar", unit + 1);
  program.set("coloured", coloured_ ? 1 : 0);
  program.set("range", std::array<float, 2>{low_, high_});
  program.set("isolines", isolines_);
  program.set("below", below_);
  program.set("above", above_);
  program.set("no_number", no_number_);
  program.set("dyed", dyed_ ? 1 : 0);
  dye_texture_.bind(unit + 2);
  program.set("dye", unit + 2);
  for (std::size_t d = 0; d < most_dyes; ++d) {
    std::array<float, 3> ink{};
    for (std::size_t k = 0; k < 3; ++k) ink[k] = float(dye_inks[d][k]) / 255;
    program.set(("inks[" + std::to_string(d) + "]").c_str(), ink);
  }
  program.set("dye_strength", std::array<float, 4>{float(dye_cover), float(dye_least_light),
                                                   float(dye_full_light / 255), float(least_drawn_dye)});
  return unit + 3;
}

void SurfacePass::set_texture(SurfaceTexture texture, const TextureLayout& layout) {
  texture_ = std::move(texture);
  layout_ = layout;
  textured_ = textured() ? Program("surface.vert", "surface.frag",
                                   std::visit([](const auto& t) { return t.prelude(); }, texture_))
                         : Program();
}

void SurfacePass::draw(const View& view, const SurfaceBuffers& surface, const SurfaceColours& colours,
                       const BufferTexture* shown, BackFaces back_faces, const SurfaceOver& over) const {
  const bool looks_up = shown && textured();
  const Program& program = looks_up ? textured_ : plain_;
  set_view(program, view, surface.placement());
  const int unit = colours.bind(program, 0);
  if (looks_up) {
    const auto bind = [&](const auto& texture) {
      texture.bind(program, *shown, unit);
      const Vec3d offset = (surface.origin() - texture.origin()) / texture.texture_cell();
      program.set("texture_from_model", std::array<float, 4>{float(offset.x), float(offset.y), float(offset.z),
                                                             float(surface.size() / texture.texture_cell())});
      const Vec3f shift(layout_.sheet_shift / texture.texture_cell());
      program.set("sheet_shift", std::array<float, 3>{shift.x, shift.y, shift.z});
      program.set("values", int(layout_.values));
    };
    std::visit(bind, texture_);
  }
  program.set("opacity", over.opacity);
  program.use();
  glEnable(GL_DEPTH_TEST);
  const Blended blended(over.opacity < 1);
  const bool one_sided = surface.closed() && view.clip.empty();
  draw_sides(program, surface, one_sided, back_faces, over.nearer);
}

}  // namespace nacre
