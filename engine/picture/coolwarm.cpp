// Nacre: the diverging map from a cool blue to a warm red, as Moreland defines it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/picture/colormap_tables.hpp"

namespace nacre {
namespace {

/// Polar coordinates of CIELAB: magnitude, saturation (angle from the axis of grays), hue. Moreland 2009, sec. 4.
struct Msh {
  double magnitude, saturation, hue;
};

constexpr double white[] = {0.95047, 1, 1.08883};  // D65
constexpr double to_xyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr double from_xyz[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
constexpr double knee = 6.0 / 29;  ///< of CIELAB's cube root

Msh msh_of(const Color& srgb) {
  double f[3];
  for (int k = 0; k < 3; ++k) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) sum += to_xyz[k][j] * double(linear_from_srgb(srgb[std::size_t(j)]));
    sum /= white[k];
    f[k] = sum > knee * knee * knee ? std::cbrt(sum) : sum / (3 * knee * knee) + 4.0 / 29;
  }
  const double lightness = 116 * f[1] - 16, a = 500 * (f[0] - f[1]), b = 200 * (f[1] - f[2]);
  const double magnitude = std::hypot(lightness, a, b);
  return {magnitude, std::acos(lightness / magnitude), std::atan2(b, a)};
}

Color srgb_of_msh(const Msh& c) {
  const double lightness = c.magnitude * std::cos(c.saturation), chroma = c.magnitude * std::sin(c.saturation);
  const double y = (lightness + 16) / 116;
  const double f[3] = {y + chroma * std::cos(c.hue) / 500, y, y - chroma * std::sin(c.hue) / 200};
  Color srgb{};
  for (int k = 0; k < 3; ++k) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      const double v = f[j] > knee ? f[j] * f[j] * f[j] : 3 * knee * knee * (f[j] - 4.0 / 29);
      sum += from_xyz[k][j] * white[j] * v;
    }
    srgb[std::size_t(k)] = srgb_from_linear(std::clamp(float(sum), 0.0f, 1.0f));
  }
  return srgb;
}

/// The hue that an unsaturated colour of that magnitude is given, so that the path to it does not bend.
double spun_hue(const Msh& saturated, double magnitude) {
  if (saturated.magnitude >= magnitude) return saturated.hue;
  const double spin = saturated.saturation *
                      std::sqrt(magnitude * magnitude - saturated.magnitude * saturated.magnitude) /
                      (saturated.magnitude * std::sin(saturated.saturation));
  return saturated.hue > -std::numbers::pi / 3 ? saturated.hue + spin : saturated.hue - spin;
}

}  // namespace

std::vector<Color> coolwarm_colours(int count) {
  const auto bytes = [](int r, int g, int b) { return Color{float(r) / 255, float(g) / 255, float(b) / 255}; };
  const Msh cool = msh_of(bytes(59, 76, 192)), warm = msh_of(bytes(180, 4, 38));
  const double middle = std::max({cool.magnitude, warm.magnitude, 88.0});
  std::vector<Color> colours;
  for (int i = 0; i < count; ++i) {
    const double t = double(i) / (count - 1);
    const Msh& end = t < 0.5 ? cool : warm;
    const double s = t < 0.5 ? 2 * t : 2 - 2 * t;  // from the end to the middle
    const double hue = spun_hue(end, middle);
    colours.push_back(srgb_of_msh(
        {end.magnitude + s * (middle - end.magnitude), (1 - s) * end.saturation, end.hue + s * (hue - end.hue)}));
  }
  return colours;
}

}  // namespace nacre
