// Nacre: putting images over each other.
#include "engine/picture/compose.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

std::uint8_t to_byte(float c) { return std::uint8_t(std::lround(std::clamp(c, 0.f, 255.f))); }

}  // namespace

Image clear_sheet(int width, int height, const Rgba& paper) {
  Image sheet;
  sheet.width = width;
  sheet.height = height;
  sheet.pixels.assign(std::size_t(width) * std::size_t(height) * 4, 0);
  sheet.paper = {paper.r, paper.g, paper.b};
  return sheet;
}

void blend_pixel(std::uint8_t* pixel, Rgba color, float coverage) {
  const float top = std::clamp(coverage, 0.f, 1.f) * float(color.a) / 255;
  if (top <= 0) return;
  const float below = (1 - top) * float(pixel[3]) / 255, alpha = top + below;
  const std::uint8_t channels[3] = {color.r, color.g, color.b};
  for (int k = 0; k < 3; ++k) pixel[k] = to_byte((top * float(channels[k]) + below * float(pixel[k])) / alpha);
  pixel[3] = to_byte(255 * alpha);
}

void blend_over(Image& bottom, const Image& top, int x, int y) {
  const int first_x = std::max(0, -x), last_x = std::min(top.width, bottom.width - x);
  const int first_y = std::max(0, -y), last_y = std::min(top.height, bottom.height - y);
  for (int v = first_y; v < last_y; ++v)
    for (int u = first_x; u < last_x; ++u) {
      const std::uint8_t* pixel = top.at(u, v);
      blend_pixel(bottom.at(x + u, y + v), {pixel[0], pixel[1], pixel[2], pixel[3]});
    }
}

Image on_canvas(const Image& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  Image canvas(width, height);
  for (std::size_t i = 0; i < canvas.pixels.size(); ++i) canvas.pixels[i] = image.pixels[i % 4];
  const int left = (width - image.width) / 2, top = (height - image.height) / 2;
  const int first = std::max(0, left), past = std::min(width, left + image.width);
  for (int y = std::max(0, top); y < std::min(height, top + image.height); ++y)
    std::copy_n(image.at(first - left, y - top), std::size_t(past - first) * 4, canvas.at(first, y));
  return canvas;
}

}  // namespace nacre
