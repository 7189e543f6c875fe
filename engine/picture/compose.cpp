// Nacre: putting images over each other and making them smaller.
#include "engine/picture/compose.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "engine/picture/oklab.hpp"

namespace nacre {
namespace {

/// Finest encoded step, near black, is 1 / (255 * 12.92) in linear light: 16384 levels resolve it four times over.
constexpr int linear_levels = 16384;

const std::array<float, 256>& linear_table() {
  static const auto table = [] {
    std::array<float, 256> t{};
    for (int i = 0; i < 256; ++i) t[i] = linear_from_srgb(float(i) / 255);
    return t;
  }();
  return table;
}

const std::array<std::uint8_t, linear_levels>& encoded_table() {
  static const auto table = [] {
    std::array<std::uint8_t, linear_levels> t{};
    for (int i = 0; i < linear_levels; ++i)
      t[i] = std::uint8_t(std::lround(255 * srgb_from_linear(float(i) / (linear_levels - 1))));
    return t;
  }();
  return table;
}

std::uint8_t to_byte(float c) { return std::uint8_t(std::lround(std::clamp(c, 0.f, 255.f))); }

/// The mean of the block of `image` whose left upper corner is (x0, y0).
void average_block(const Image& image, int x0, int y0, int width, int height, std::uint8_t* out) {
  const auto& linear = linear_table();
  std::array<float, 3> sum{};
  float alpha_sum = 0;
  for (int y = y0; y < y0 + height; ++y)
    for (int x = x0; x < x0 + width; ++x) {
      const std::uint8_t* pixel = image.at(x, y);
      const float alpha = pixel[3];
      for (int k = 0; k < 3; ++k) sum[k] += alpha * linear[pixel[k]];
      alpha_sum += alpha;
    }
  for (int k = 0; k < 3; ++k) {
    const float mean = alpha_sum > 0 ? sum[k] / alpha_sum : 0;
    out[k] = encoded_table()[std::min(int(std::lround(mean * (linear_levels - 1))), linear_levels - 1)];
  }
  out[3] = to_byte(alpha_sum / float(width * height));
}

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

Image downsample(const Image& image, int factor) {
  assert(factor >= 1);
  if (factor == 1 || image.width == 0 || image.height == 0) return image;
  const int block_width = std::min(factor, image.width), block_height = std::min(factor, image.height);
  Image small(std::max(1, image.width / factor), std::max(1, image.height / factor));
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      average_block(image, x * factor, y * factor, block_width, block_height, small.at(x, y));
  return small;
}

}  // namespace nacre
