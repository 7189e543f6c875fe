// Nacre: text and strokes that are readable on any background.
#include "engine/picture/lettering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/picture/oklab.hpp"
#include "engine/picture/text.hpp"

namespace nacre {
namespace {

constexpr float smallest_font = 10;
constexpr Ink dark_ink{{24, 26, 30, 255}, {255, 255, 255, 110}};
constexpr Ink light_ink{{242, 243, 245, 255}, {0, 0, 0, 110}};

/// OKLab lightness of a pixel of the image, with the paper behind it.
float lightness(const Image& image, const std::uint8_t* pixel) {
  const float alpha = float(pixel[3]) / 255;
  Color color;
  for (int k = 0; k < 3; ++k)
    color[k] = linear_from_srgb((alpha * float(pixel[k]) + (1 - alpha) * float(image.paper[k])) / 255);
  return oklab_from_linear(color)[0];
}

}  // namespace

float lettering_size(int width, int height) {
  const float shorter = std::min(0.75f * float(width), float(height));
  return shorter < 12 * smallest_font ? 0 : std::max(smallest_font, std::round(shorter / 44));
}

Ink ink_for(const Image& image, int x, int y, int width, int height) {
  const int x1 = std::min(image.width, x + width), y1 = std::min(image.height, y + height);
  const int stride = std::max(1, std::min(width, height) / 24);
  float sum = 0;
  int count = 0;
  for (int v = std::max(0, y); v < y1; v += stride)
    for (int u = std::max(0, x); u < x1; u += stride, ++count) sum += lightness(image, image.at(u, v));
  return count == 0 || sum > 0.6f * float(count) ? dark_ink : light_ink;
}

Ink ink_on(const Rgba& paper) {
  const bool dark = paper.a > 0 && paper.r + paper.g + paper.b < 384;
  return dark ? Ink{{255, 255, 255, 255}, {0, 0, 0, 190}} : Ink{{20, 20, 24, 255}, {255, 255, 255, 210}};
}

void draw_lettering(Image& image, int x, int y, std::string_view text, float pixels, const Ink& ink) {
  constexpr int directions = 12;
  for (const float radius : {pixels / 6, pixels / 12})
    for (int i = 0; i < directions; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * float(i) / directions;
      draw_text(image, x + int(std::lround(radius * std::cos(angle))), y + int(std::lround(radius * std::sin(angle))),
                text, pixels, ink.halo);
    }
  draw_text(image, x, y, text, pixels, ink.letter);
}

void draw_stroke(Image& image, float x0, float y0, float r0, float x1, float y1, float r1, Rgba color) {
  const float reach = std::max(r0, r1) + 1;
  const int left = std::max(0, int(std::floor(std::min(x0, x1) - reach)));
  const int right = std::min(image.width, int(std::ceil(std::max(x0, x1) + reach)));
  const int top = std::max(0, int(std::floor(std::min(y0, y1) - reach)));
  const int bottom = std::min(image.height, int(std::ceil(std::max(y0, y1) + reach)));
  const float dx = x1 - x0, dy = y1 - y0, square = dx * dx + dy * dy;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const float px = float(x) + 0.5f - x0, py = float(y) + 0.5f - y0;
      const float along = square > 0 ? std::clamp((px * dx + py * dy) / square, 0.f, 1.f) : 0.f;
      const float outside = std::hypot(px - along * dx, py - along * dy) - (r0 + along * (r1 - r0));
      blend_pixel(image.at(x, y), color, std::clamp(0.5f - outside, 0.f, 1.f));
    }
}

void fill_box(Image& image, int x, int y, int width, int height, Rgba color) {
  for (int v = std::max(0, y); v < std::min(image.height, y + height); ++v)
    for (int u = std::max(0, x); u < std::min(image.width, x + width); ++u) blend_pixel(image.at(u, v), color);
}

}  // namespace nacre
