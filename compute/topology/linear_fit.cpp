// Nacre: the linear vector field that fits best around a point of a surface.
#include "compute/topology/linear_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nacre {
namespace {

using Three = std::array<double, 3>;

/// The inverse of a symmetric matrix of three rows; false where there is none.
bool invert(const std::array<Three, 3>& a, std::array<Three, 3>& b) {
  const auto minor = [&](int i, int j) {
    const int r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return a[r][c] * a[s][d] - a[r][d] * a[s][c];
  };
  const double determinant = a[0][0] * minor(0, 0) + a[0][1] * minor(0, 1) + a[0][2] * minor(0, 2);
  if (!(std::fabs(determinant) > 1e-12 * std::fabs(a[0][0] * a[1][1] * a[2][2]))) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) b[i][j] = minor(j, i) / determinant;
  return true;
}

/// Weights of a point at the corners of a triangle in a plane.
Three weights_in(const std::array<Vec2d, 3>& p, const Vec2d& x) {
  const auto twice = [](const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  };
  const double whole = twice(p[0], p[1], p[2]);
  if (whole == 0) return {-1e300, -1e300, -1e300};
  return {twice(x, p[1], p[2]) / whole, twice(p[0], x, p[2]) / whole, twice(p[0], p[1], x) / whole};
}

}  // namespace

LinearFit fit_linear(const TangentField& field, std::uint32_t centre, std::span<const std::uint32_t> triangles) {
  LinearFit fit;
  fit.triangle = centre;
  const auto [x_axis, y_axis, normal] = field.frame(centre);
  const Vec3d origin =
      (field.corner_point(3 * centre) + field.corner_point(3 * centre + 1) + field.corner_point(3 * centre + 2)) / 3.0;
  const auto flat = [&, x_axis = x_axis, y_axis = y_axis](const Vec3d& p) {  // as far from the origin as in space
    const Vec3d d = p - origin;
    const Vec2d q{dot(d, x_axis), dot(d, y_axis)};
    const double n = std::hypot(q.x, q.y), stretch = n > 0 ? length(d) / n : 1;
    return Vec2d{q.x * stretch, q.y * stretch};
  };
  struct Sample {
    std::uint32_t vertex;
    Vec2d x, v;
  };
  std::vector<Sample> samples;
  if (triangles.size() == 1) {
    const std::array<Vec2d, 3> corners = field.corner_vectors(triangles[0]);
    for (std::uint32_t k = 0; k < 3; ++k)
      samples.push_back({k, flat(field.corner_point(3 * triangles[0] + k)), corners[k]});
  } else {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t t : triangles)
      for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) corners.push_back(c);
    std::sort(corners.begin(), corners.end(),
              [&](std::uint32_t a, std::uint32_t b) { return field.vertex(a) < field.vertex(b); });
    for (const std::uint32_t c : corners) {
      const std::uint32_t v = field.vertex(c);
      if (!samples.empty() && samples.back().vertex == v) continue;
      const Vec3d turned_value = turned(field.value(v), field.normal(v), normal);
      samples.push_back({v, flat(field.corner_point(c)), {dot(turned_value, x_axis), dot(turned_value, y_axis)}});
    }
  }

  double size = 0;
  for (const Sample& s : samples) size = std::max(size, std::hypot(s.x.x, s.x.y));
  if (!(size > 0)) return fit;
  std::array<Three, 3> sums{}, inverse{};
  Three right_x{}, right_y{};
  for (const Sample& s : samples) {
    const Three row{1, s.x.x / size, s.x.y / size};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) sums[i][j] += row[i] * row[j];
      right_x[i] += row[i] * s.v.x;
      right_y[i] += row[i] * s.v.y;
    }
  }
  if (!invert(sums, inverse)) return fit;
  Three p{}, q{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) p[i] += inverse[i][j] * right_x[j], q[i] += inverse[i][j] * right_y[j];
  double rest = 0;
  for (const Sample& s : samples) {
    const double u = p[0] + (p[1] * s.x.x + p[2] * s.x.y) / size - s.v.x;
    const double v = q[0] + (q[1] * s.x.x + q[2] * s.x.y) / size - s.v.y;
    rest += u * u + v * v;
  }
  const double a = p[1] / size, b = p[2] / size, c = q[1] / size, d = q[2] / size;
  if (samples.size() > 3) {
    const double variance = rest / double(2 * samples.size() - 6);
    fit.real_error = 0.5 * std::sqrt(std::max(0.0, variance * (inverse[1][1] + inverse[2][2]))) / size;
  }
  fit.determinant = a * d - b * c;
  const double half = 0.5 * (a + d), root = half * half - fit.determinant;
  if (root >= 0) {
    fit.first = half + std::sqrt(root);
    fit.second = half - std::sqrt(root);
    const auto axis = [&, x_axis = x_axis, y_axis = y_axis](double value) {  // of the larger row of J - value
      const double u1 = b, v1 = value - a, u2 = value - d, v2 = c;
      const bool upper = std::hypot(u1, v1) >= std::hypot(u2, v2);
      return normalized(x_axis * (upper ? u1 : u2) + y_axis * (upper ? v1 : v2));
    };
    fit.first_axis = axis(fit.first.real());
    fit.second_axis = axis(fit.second.real());
  } else {
    fit.first = {half, std::sqrt(-root)};
    fit.second = std::conj(fit.first);
  }
  if (fit.determinant == 0) return fit;
  const Vec2d zero{-(d * p[0] - b * q[0]) / fit.determinant, -(a * q[0] - c * p[0]) / fit.determinant};

  double best = -1e300;
  Three weights{};
  for (const std::uint32_t t : triangles) {
    std::array<Vec2d, 3> corners;
    for (std::uint32_t k = 0; k < 3; ++k) corners[k] = flat(field.corner_point(3 * t + k));
    const Three w = weights_in(corners, zero);
    const double least = std::min({w[0], w[1], w[2]});
    if (least > best) best = least, weights = w, fit.triangle = t;
  }
  fit.found = best > (triangles.size() == 1 ? -1 : -0.2);
  double sum = 0;
  for (double& w : weights) sum += w = std::clamp(w, 0.0, 1.0);
  if (sum > 0) fit.weights = Vec3d(weights[0], weights[1], weights[2]) / sum;
  return fit;
}

}  // namespace nacre
