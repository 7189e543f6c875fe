// Nacre: the colours of materials.
#include "engine/picture/material_colours.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {

Color material_colour(int material) {
  constexpr int hues = 7;  // as many as the eye can distinguish; then they are repeated, darker or lighter
  constexpr std::array<float, 4> lightness{0.74f, 0.57f, 0.84f, 0.46f}, chroma{0.11f, 0.12f, 0.08f, 0.1f};
  const int round = std::max(0, material - 1) / hues;
  const std::size_t level = std::size_t(round) % lightness.size();
  const float hue = 0.6f + 2.3999632f * float(material) + 0.2f * float(round);
  Color rgb = linear_from_oklab({lightness[level], chroma[level] * std::cos(hue), chroma[level] * std::sin(hue)});
  for (float& c : rgb) c = srgb_from_linear(std::clamp(c, 0.0f, 1.0f));
  return rgb;
}

static Color mixture(bool outside, const Color& a, const Color& b) {
  if (outside) return b;
  Color mixed;
  for (std::size_t k = 0; k < 3; ++k) mixed[k] = 0.35f + 0.65f * 0.5f * (a[k] + b[k]);
  return mixed;
}

Color pair_colour(const std::array<std::uint16_t, 2>& pair) {
  return mixture(pair[0] == 0, material_colour(pair[0]), material_colour(pair[1]));
}

Color pair_colour(const std::array<std::uint16_t, 2>& pair, std::span<const Color> palette) {
  return mixture(pair[0] == 0, palette[pair[0]], palette[pair[1]]);
}

}  // namespace nacre
