// Nacre: the colours of materials.
#include "engine/picture/material_colours.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {

Color material_colour(int material) {
  const float hue = 0.6f + 2.3999632f * float(material), chroma = 0.11f;
  Color rgb = linear_from_oklab({0.74f, chroma * std::cos(hue), chroma * std::sin(hue)});
  for (float& c : rgb) c = srgb_from_linear(std::clamp(c, 0.0f, 1.0f));
  return rgb;
}

Color pair_colour(const std::array<std::uint16_t, 2>& pair) {
  const Color b = material_colour(pair[1]);
  if (pair[0] == 0) return b;
  const Color a = material_colour(pair[0]);
  Color mixed;
  for (std::size_t k = 0; k < 3; ++k) mixed[k] = 0.35f + 0.65f * 0.5f * (a[k] + b[k]);
  return mixed;
}

}  // namespace nacre
