// Nacre: an 8-bit image in host memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nacre {

/// RGBA, 8 bits a channel, sRGB, row 0 at the top: `pixels[(y * width + x) * 4 + channel]`.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
  std::array<std::uint8_t, 3> paper{255, 255, 255};  ///< seen through transparent pixels, to choose text colours

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(std::size_t(w) * h * 4, 255) {}

  std::uint8_t* at(int x, int y) { return &pixels[(std::size_t(y) * width + x) * 4]; }
  const std::uint8_t* at(int x, int y) const { return &pixels[(std::size_t(y) * width + x) * 4]; }
};

}  // namespace nacre
