// Nacre: conversions between sRGB, linear light and OKLab.
#pragma once

#include <array>
#include <cmath>

namespace nacre {

/// Three channels: encoded sRGB or linear light (0..1 in gamut), or OKLab (L 0..1, a, b).
using Color = std::array<float, 3>;

/// One channel, 0..1, from encoded sRGB to linear light (IEC 61966-2-1).
inline float linear_from_srgb(float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); }

/// One channel, 0..1, from linear light to encoded sRGB (IEC 61966-2-1).
inline float srgb_from_linear(float c) {
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}

/// OKLab (Ottosson 2020, sec. "Converting from linear sRGB to Oklab") of a colour in linear sRGB.
inline Color oklab_from_linear(const Color& rgb) {
  const auto [r, g, b] = rgb;
  const float l = std::cbrt(0.4122214708f * r + 0.5363325363f * g + 0.0514459929f * b);
  const float m = std::cbrt(0.2119034982f * r + 0.6806995451f * g + 0.1073969566f * b);
  const float s = std::cbrt(0.0883024619f * r + 0.2817188376f * g + 0.6299787005f * b);
  return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
          1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
          0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

/// The inverse of `oklab_from_linear`. Colours outside sRGB's gamut have channels below 0 or above 1.
inline Color linear_from_oklab(const Color& lab) {
  const auto [L, a, b] = lab;
  const auto cube = [](float x) { return x * x * x; };
  const float l = cube(L + 0.3963377774f * a + 0.2158037573f * b);
  const float m = cube(L - 0.1055613458f * a - 0.0638541728f * b);
  const float s = cube(L - 0.0894841775f * a - 1.2914855480f * b);
  return {4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
          -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
          -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
}

}  // namespace nacre
