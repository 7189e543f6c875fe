// Nacre: tests: do two pictures show the same to someone who looks at them?
#pragma once

#include <algorithm>
#include <cstdlib>

#include "engine/picture/image.hpp"

namespace nacre::test {

constexpr double shade = 40;         ///< of 255: less than this is no other colour
constexpr double few_pixels = 0.02;  ///< of a picture

inline bool differ(const std::uint8_t* a, const std::uint8_t* b) {
  for (int c = 0; c < 4; ++c)
    if (std::abs(int(a[c]) - int(b[c])) > shade) return true;
  return false;
}

/// Share of the pixels of `a` for which `b`, of the same size, has nothing alike within `reach` pixels.
inline double share_unmatched(const Image& a, const Image& b, int reach) {
  std::size_t unmatched = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      bool found = false;
      for (int v = std::max(0, y - reach); v <= std::min(a.height - 1, y + reach) && !found; ++v)
        for (int u = std::max(0, x - reach); u <= std::min(a.width - 1, x + reach) && !found; ++u)
          found = !differ(a.at(x, y), b.at(u, v));
      unmatched += !found;
    }
  return double(unmatched) / double(a.width * a.height);
}

/// Every pixel is the mean of the square that reaches so far from it.
inline Image seen_from_afar(const Image& image, int reach) {
  Image far(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int sum[4] = {}, count = 0;
      for (int v = std::max(0, y - reach); v <= std::min(image.height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(image.width - 1, x + reach); ++u, ++count)
          for (int c = 0; c < 4; ++c) sum[c] += image.at(u, v)[c];
      for (int c = 0; c < 4; ++c) far.at(x, y)[c] = std::uint8_t(sum[c] / count);
    }
  return far;
}

/// Pixel by pixel: for panels, surfaces, letters.
inline bool are_same(const Image& a, const Image& b) { return share_unmatched(a, b, 0) < few_pixels; }

/// For a crowd of small discs, none of which has to be where it was. What is in one picture is near by in the other,
/// too; and where eyes cannot part the discs, they cover as much, in the same colours. The first finds what is missing,
/// thin lines, too; the second, other sizes.
inline bool are_alike(const Image& a, const Image& b) {
  constexpr int near_by = 3, afar = 7;  // pixels, where a disc has five
  return std::max(share_unmatched(a, b, near_by), share_unmatched(b, a, near_by)) < few_pixels &&
         are_same(seen_from_afar(a, afar), seen_from_afar(b, afar));
}

}  // namespace nacre::test
