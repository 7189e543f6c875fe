// Nacre: putting images over each other and making them smaller.
#pragma once

#include <cstdint>

#include "engine/picture/image.hpp"

namespace nacre {

/// A colour with coverage: encoded sRGB and alpha (255 is opaque), not premultiplied.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
};

/// An image to draw on that is put over another one later: all transparent, with `paper` behind it.
Image clear_sheet(int width, int height, const Rgba& paper);

/// Puts `color` over one pixel (four channels), in encoded sRGB as compositors do. `coverage` (0..1) scales its alpha.
void blend_pixel(std::uint8_t* pixel, Rgba color, float coverage = 1);

/// Puts `top` over `bottom` with top's left upper corner at (x, y); what lies outside `bottom` is cut off.
void blend_over(Image& bottom, const Image& top, int x = 0, int y = 0);

/// The image in the middle of one of another size: cut off, or framed in the colour of its left upper corner.
Image on_canvas(const Image& image, int width, int height);

/// The mean of each factor x factor block in linear light, weighted by alpha. The result has width / factor by
/// height / factor pixels (at least one each way); columns and rows that fill no block are left out.
Image downsample(const Image& image, int factor);

}  // namespace nacre
