// Nacre: built-in sample on a high-speed train in a side wind: wall shear with travelling vortices on the lee side.
#include <algorithm>
#include <array>
#include <numbers>

#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;
constexpr double half_length = 5.0;  // the train lies along x, its nose at -5, the track at z = 0
constexpr double train_half_width = 0.5664;
constexpr double bottom = 0.15, top = 1.4977;
constexpr double nose_length = 2.0;
constexpr double tip_height = 0.52;

/// The cross-section at `x`: a superellipse.
struct Section {
  double half_width, half_height, middle, exponent;
};

Section section(double x) {
  const double u = std::min((half_length - std::abs(x)) / nose_length, 1.0);  // 0 at a tip, 1 at the body
  const auto dome = [u](double power) { return std::sqrt(std::max(1 - std::pow(1 - u, power), 0.0)); };
  const double roof = tip_height + (top - tip_height) * dome(2.2) * (0.62 + 0.38 * smooth_step(0.1, 0.95, u));
  const double floor = tip_height + (bottom - tip_height) * dome(4.0);
  return {train_half_width * dome(2.6), (roof - floor) / 2, (roof + floor) / 2, 2.2 + 2.3 * smooth_step(0.1, 1.0, u)};
}

/// The point at `s` (0 at the nose, 1 at the tail; quadratic there, which makes the round tips regular) and direction
/// `angle` about the axis (0: +y, a quarter turn: up).
Vec3d surface_point(double s, double angle) {
  const double x = -half_length * std::cos(pi * s);
  const Section cut = section(x);
  const double y = std::cos(angle), z = std::sin(angle);
  const double a = std::max(cut.half_width, 1e-12), b = std::max(cut.half_height, 1e-12);
  // Radius of the superellipse in that direction, scaled so that thin sections neither over- nor underflow.
  const double r =
      std::pow(std::pow(std::abs(y), cut.exponent) + std::pow(std::abs(z) * a / b, cut.exponent), -1 / cut.exponent);
  return {x, a * r * y, cut.middle + a * r * z};
}

Vec3d surface_normal(double s, double angle) {
  if (s <= 0 || s >= 1) return {s <= 0 ? -1.0 : 1.0, 0, 0};
  constexpr double h = 1e-6;
  const Vec3d along = surface_point(s + h, angle) - surface_point(s - h, angle);
  const Vec3d around = surface_point(s, angle + h) - surface_point(s, angle - h);
  return normalized(cross(around, along));
}

/// Values of `s` at `count` + 1 rings that are equally far apart, measured along the surface.
class Meridian {
 public:
  Meridian() {
    for (int i = 0; i < sample_count; ++i) {
      double step = 0;
      for (int k = 0; k < 8; ++k)
        step += length(surface_point((i + 1.0) / sample_count, pi * k / 4) -
                       surface_point(double(i) / sample_count, pi * k / 4));
      lengths_[i + 1] = lengths_[i] + step / 8;
    }
  }

  double total() const { return lengths_.back(); }
  double s_at(double distance) const {
    const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, distance);
    const double fraction = (distance - *(next - 1)) / (*next - *(next - 1));
    return std::clamp((double(next - lengths_.begin()) - 1 + fraction) / sample_count, 0.0, 1.0);
  }

 private:
  static constexpr int sample_count = 4096;
  std::array<double, sample_count + 1> lengths_{};
};

/// A box lattice wrapped around the train. Rings of points run around its sides; on the two end faces they shrink to
/// the tip as squares within squares, so that triangles stay of one size.
SampleShape train_shape(int detail) {
  const Meridian meridian;
  const double edge = 2 * half_length / detail;
  const int across = 2 * std::max(1, int(std::lround(0.5 * (train_half_width + (top - bottom) / 2) * 0.92 / edge)));
  const int along = std::max(4, int(std::lround(meridian.total() / edge)) - across);

  LatticeBox box = lattice_box(along, across, across);
  SampleShape shape;
  shape.triangles = std::move(box.triangles);
  for (const Int3& p : box.points) {
    const double v = 2.0 * p.y / across - 1, w = 2.0 * p.z / across - 1;
    const double ring = std::max(std::abs(v), std::abs(w));  // 1 on the sides, 0 at the tips
    double rings = p.x + across / 2.0;
    if (p.x == 0) rings = ring * across / 2;
    if (p.x == along) rings = along + across - ring * across / 2;
    const double scale = pi / 4 / std::max(ring, 1e-12);
    const double angle = std::atan2(std::tan(w * scale), std::tan(v * scale));
    const double s = ring == 0 ? double(p.x != 0) : meridian.s_at(meridian.total() * rings / (along + across));
    shape.points.push_back(surface_point(s, angle));
    shape.normals.push_back(surface_normal(s, angle));
  }
  return shape;
}

/// Flow around the section at `angle`: away from the attachment lines, towards the separation lines, which waver along
/// the train. Positive turns from +y (lee) to up.
double crossflow(double x, double angle, double phase) {
  const auto wave = [&](double count, double shift) { return std::sin(count * pi / half_length * x - phase + shift); };
  const double windward = pi * (1.0 + 0.04 * wave(2, 0.0));      // attachment
  const double roof_edge = pi * (0.36 + 0.05 * wave(4, 1.0));    // separation
  const double lee = pi * (0.03 + 0.07 * wave(6, 2.0));          // reattachment
  const double floor_edge = pi * (-0.30 + 0.04 * wave(3, 0.5));  // separation
  const auto factor = [angle](double line) { return std::sin((angle - line) / 2); };
  return 3.2 * factor(windward) * factor(roof_edge) * factor(lee) * factor(floor_edge);
}

/// Vortices that drift along the lee wall and, weaker, along the roof; one spacing a period, so that the loop closes.
std::vector<Eddy> travelling_eddies(double time) {
  constexpr double spacing = 1.6;
  std::vector<Eddy> eddies;
  const auto add = [&eddies](double x, double y, double z, double radius, double spin, double spread) {
    const double strength = smooth_step(-4.6, -2.5, x) * (1 - smooth_step(3.6, 4.8, x));
    eddies.push_back({{x, y, z}, radius, spin * strength, spread * strength});
  };
  for (int i = -1; i < 7; ++i) {
    const double x = -half_length + spacing * (i + time);
    add(x, train_half_width, 1.02, 0.30, -0.95, -0.3);
    add(x + 0.5 * spacing, train_half_width, 0.58, 0.22, 0.75, 0.2);
    add(x + 0.25 * spacing, 0.12, top, 0.22, 0.5, -0.25);
  }
  return eddies;
}

SampleField train_flow(double time) {
  const double phase = 2 * pi * time;
  return [phase, eddies = travelling_eddies(time)](const Vec3d& p, const Vec3d& n) {
    const double angle = std::atan2(p.z - section(p.x).middle, p.y);
    const double windward = 0.5 - 0.5 * std::cos(angle);  // 1 on the windward side, 0 on the lee side
    const double pulse = 1 + 0.15 * std::sin(3 * pi / half_length * p.x - phase);
    const Vec3d stream = tangential({(0.28 + 0.54 * windward) * pulse, 0.18, 0}, n);
    return stream + cross(Vec3d{1, 0, 0}, n) * crossflow(p.x, angle, phase) + sum_of(eddies, p, n);
  };
}

}  // namespace

SampleDefinition train_sample() {
  return {{"train", "high-speed train in a wind of 30 degrees yaw: attachment, separation, vortices on the lee side"},
          400,
          24,
          24,
          train_shape,
          train_flow};
}

}  // namespace nacre
