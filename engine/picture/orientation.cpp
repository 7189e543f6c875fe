// Nacre: the small coordinate axes in the corner of a picture.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/picture/legend.hpp"
#include "engine/picture/lettering.hpp"
#include "engine/picture/text.hpp"

namespace nacre {
namespace {

/// One axis as the camera sees it: horizontal and vertical in units of the axis' length; `depth` is away from the eye.
struct Axis {
  const char* name;
  Rgba color;
  float across, down, depth;
};

Axis seen(int k, const Vec3f& right, const Vec3f& up, const Vec3f& forward) {
  static constexpr const char* names[] = {"x", "y", "z"};
  static constexpr Rgba colors[] = {{222, 62, 52}, {44, 158, 66}, {58, 122, 240}};
  return {names[k], colors[k], right[k], -up[k], forward[k]};
}

/// A shaft that ends in a pointed head; the head of an axis that points at the eye shrinks to a dot.
void draw_arrow(Image& image, const Axis& axis, float x, float y, float size, float font, float grow, Rgba color) {
  const float seen_length = std::hypot(axis.across, axis.down);
  const float head = std::min(0.32f, 0.6f * seen_length) / std::max(seen_length, 1e-6f);
  const float tip_x = x + size * axis.across, tip_y = y + size * axis.down;
  const float neck_x = tip_x - head * size * axis.across, neck_y = tip_y - head * size * axis.down;
  const float shaft = 0.075f * font;
  draw_stroke(image, x, y, shaft + grow, neck_x, neck_y, shaft + grow, color);
  draw_stroke(image, neck_x, neck_y, 0.24f * font + grow, tip_x, tip_y, 0.03f * font + grow, color);
}

void draw_name(Image& image, const Axis& axis, float x, float y, float size, float font, const Ink& ink) {
  const float seen_length = std::hypot(axis.across, axis.down);
  // If the axis points at the eye, its name goes to the upper left, where another name is unlikely.
  const float ux = seen_length > 0.15f ? axis.across / seen_length : -0.7f;
  const float uy = seen_length > 0.15f ? axis.down / seen_length : -0.7f;
  const float center_x = x + size * axis.across + 0.72f * font * ux;
  const float center_y = y + size * axis.down + 0.72f * font * uy;
  // Lower-case letters are three quarters as high as capitals.
  const int cap = text_cap_height(font);
  draw_lettering(image, int(std::lround(center_x)) - text_width(axis.name, font) / 2,
                 int(std::lround(center_y - 0.62f * float(cap))), axis.name, font, ink);
}

constexpr float axis_length = 2.6f, reach_of_triad = axis_length + 2.1f;  // in font sizes; its centre to the border

void draw_triad(Image& image, float font, const Vec3f& right, const Vec3f& up, const Vec3f& forward) {
  const float size = axis_length * font, reach = reach_of_triad * font;
  const float x = float(image.width) - reach, y = float(image.height) - reach;
  const int side = int(2 * size);
  const Ink ink = ink_for(image, int(x - size), int(y - size), side, side);

  std::array<Axis, 3> axes;
  for (int k = 0; k < 3; ++k) axes[k] = seen(k, right, up, forward);
  std::sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) { return a.depth > b.depth; });
  for (const Axis& axis : axes) {
    draw_arrow(image, axis, x, y, size, font, std::max(1.f, font / 14), {ink.halo.r, ink.halo.g, ink.halo.b, 120});
    draw_arrow(image, axis, x, y, size, font, 0, axis.color);
    draw_name(image, axis, x, y, size, font, ink);
  }
}

bool are_finite(const Vec3f& right, const Vec3f& up, const Vec3f& forward) {
  return is_finite(right) && is_finite(up) && is_finite(forward);
}

}  // namespace

void draw_orientation(Image& image, const Vec3f& right, const Vec3f& up, const Vec3f& forward) {
  const float font = lettering_size(image);
  if (font > 0 && are_finite(right, up, forward)) draw_triad(image, font, right, up, forward);
}

Image orientation_sheet(int width, int height, const Rgba& paper, const Vec3f& right, const Vec3f& up,
                        const Vec3f& forward) {
  const float font = lettering_size(width, height);
  if (font <= 0 || !are_finite(right, up, forward)) return {};
  const int side = int(std::ceil(2 * reach_of_triad * font));
  Image sheet = clear_sheet(side, side, paper);
  draw_triad(sheet, font, right, up, forward);
  return sheet;
}

}  // namespace nacre
