// Nacre: how crisp the streaks of a picture are, in pixels, and how strong; the same for the picture of any program.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "compute/device/random.hpp"

namespace nacre {

/// A number per pixel, row by row.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> value;

  Plane(int w, int h) : width(w), height(h), value(std::size_t(w) * h) {}
  double& operator()(int x, int y) { return value[std::size_t(y) * width + x]; }
  double operator()(int x, int y) const { return value[std::size_t(y) * width + x]; }
  /// The nearest pixel's where (x, y) lies outside.
  double clamped(int x, int y) const { return (*this)(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1)); }
  /// Linear between pixels.
  double at(double x, double y) const {
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double f = x - i, g = y - j;
    return (clamped(i, j) * (1 - f) + clamped(i + 1, j) * f) * (1 - g) +
           (clamped(i, j + 1) * (1 - f) + clamped(i + 1, j + 1) * f) * g;
  }
};

inline Plane combine(const Plane& a, const Plane& b, const std::function<double(double, double)>& f) {
  Plane result(a.width, a.height);
  std::transform(a.value.begin(), a.value.end(), b.value.begin(), result.value.begin(), f);
  return result;
}

inline Plane gaussian(const Plane& plane, double sigma) {
  const int reach = int(4 * sigma + 0.5);
  std::vector<double> weight;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) sum += weight.emplace_back(std::exp(-0.5 * k * k / (sigma * sigma)));
  const auto pass = [&](const Plane& from, int dx, int dy) {
    Plane to(from.width, from.height);
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x) {
        double all = 0;
        for (int k = -reach; k <= reach; ++k) all += weight[k + reach] * from.clamped(x + k * dx, y + k * dy);
        to(x, y) = all / sum;
      }
    return to;
  };
  return pass(pass(plane, 1, 0), 0, 1);
}

/// Half the difference of the pixels on either side, along x or along y.
inline Plane gradient(const Plane& plane, int dx, int dy) {
  Plane result(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x)
      result(x, y) = 0.5 * (plane.clamped(x + dx, y + dy) - plane.clamped(x - dx, y - dy));
  return result;
}

/// Which pixels differ from the background (that of a corner) and have none nearer than nine steps.
inline std::vector<bool> inside_of(std::span<const std::uint8_t> rgba, int width, int height) {
  const std::size_t corner = 4 * (std::size_t(2) * width + 2);
  std::vector<bool> inside(std::size_t(width) * height);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    int difference = 0;
    for (int c = 0; c < 3; ++c) difference += std::abs(int(rgba[4 * i + c]) - int(rgba[corner + c]));
    inside[i] = difference > 12;
  }
  for (int pass = 0; pass < 8; ++pass) {
    std::vector<bool> less(inside.size());
    for (int y = 1; y + 1 < height; ++y)
      for (int x = 1; x + 1 < width; ++x) {
        const std::size_t i = std::size_t(y) * width + x;
        less[i] = inside[i] && inside[i - 1] && inside[i + 1] && inside[i - width] && inside[i + width];
      }
    inside = std::move(less);
  }
  return inside;
}

struct Crispness {
  double across = 0, along = 0;  ///< half-width and half-length of a streak, pixels; 0 where it has no end
  double contrast = 0;           ///< median of local deviation over local mean
};

/// Of a picture of RGBA bytes.
inline Crispness crispness(std::span<const std::uint8_t> rgba, int width, int height) {
  Plane grey(width, height);
  for (std::size_t i = 0; i < grey.value.size(); ++i)
    grey.value[i] = (rgba[4 * i] + rgba[4 * i + 1] + rgba[4 * i + 2]) / 3.0;
  const Plane mean = gaussian(grey, 8), detail = combine(grey, mean, std::minus{});
  const Plane deviation = gaussian(combine(detail, detail, std::multiplies{}), 8);
  const Plane even = combine(detail, deviation, [](double d, double s) { return d / (std::sqrt(s) + 1e-6); });

  const Plane smooth = gaussian(detail, 1), gx = gradient(smooth, 1, 0), gy = gradient(smooth, 0, 1);
  const Plane xx = gaussian(combine(gx, gx, std::multiplies{}), 4),
              yy = gaussian(combine(gy, gy, std::multiplies{}), 4);
  const Plane xy = gaussian(combine(gx, gy, std::multiplies{}), 4);

  const std::vector<bool> inside = inside_of(rgba, width, height);
  std::vector<int> pixels;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i]) pixels.push_back(int(i));
  constexpr int most = 40000;
  if (int(pixels.size()) > most) {
    for (int k = 0; k < most; ++k)
      std::swap(pixels[k], pixels[k + std::size_t(uniform_random(1, k, 0) * double(pixels.size() - k))]);
    pixels.resize(most);
  }

  /// Where the correlation of a pixel with those at a distance, `turn` from across the streak, has fallen to one half.
  const auto half = [&](double turn) {
    double before = 1, whole = 0;
    for (int s = 0; s <= 40; ++s) {
      double sum = 0;
      for (const int i : pixels) {
        const double angle = 0.5 * std::atan2(2 * xy.value[i], xx.value[i] - yy.value[i]) + turn;
        sum += even.value[i] * even.at(i % width + s * std::cos(angle), i / width + s * std::sin(angle));
      }
      if (s == 0) whole = sum;
      const double now = sum / whole;
      if (now < 0.5) return s - 1 + (before - 0.5) / (before - now);
      before = now;
    }
    return 0.0;
  };
  Crispness result;
  if (pixels.empty()) return result;
  result.across = half(0);
  result.along = half(std::numbers::pi / 2);
  std::vector<double> contrasts;
  for (const int i : pixels) contrasts.push_back(std::sqrt(deviation.value[i]) / (mean.value[i] + 1));
  std::nth_element(contrasts.begin(), contrasts.begin() + contrasts.size() / 2, contrasts.end());
  result.contrast = contrasts[contrasts.size() / 2];
  return result;
}

}  // namespace nacre
