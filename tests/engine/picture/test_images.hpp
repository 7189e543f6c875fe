// Nacre: small images for tests.
#pragma once

#include <cstdint>
#include <random>

#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

inline Image plain_image(int width, int height, Rgba color) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    image.pixels[i] = color.r;
    image.pixels[i + 1] = color.g;
    image.pixels[i + 2] = color.b;
    image.pixels[i + 3] = color.a;
  }
  return image;
}

/// Nothing that an encoder could make much smaller.
inline Image noise_image(int width, int height, unsigned seed = 1, bool opaque = true) {
  Image image(width, height);
  std::minstd_rand random(seed);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (!opaque || i % 4 != 3) image.pixels[i] = std::uint8_t(random() >> 8);
  return image;
}

/// How many pixels of the box [x0, x1) x [y0, y1) differ between two images of one size.
inline int changed_pixels(const Image& a, const Image& b, int x0, int y0, int x1, int y1) {
  int count = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      bool differs = false;
      for (int k = 0; k < 4; ++k) differs |= a.at(x, y)[k] != b.at(x, y)[k];
      count += differs ? 1 : 0;
    }
  return count;
}

inline int changed_pixels(const Image& a, const Image& b) { return changed_pixels(a, b, 0, 0, a.width, a.height); }

}  // namespace nacre
