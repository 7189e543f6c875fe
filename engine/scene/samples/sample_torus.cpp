// Nacre: built-in sample on a torus: a winding flow whose helicity changes with time.
#include <numbers>

#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;
constexpr double major = 1.0;  // centre of the tube
constexpr double minor = 0.4;  // radius of the tube

SampleShape torus_shape(int detail) {
  const double edge = 2 * (major + minor) / detail;
  const int along = std::max(6, int(std::lround(2 * pi * major / edge)));
  const int around = std::max(4, int(std::lround(2 * pi * minor / edge)));
  SampleShape shape;
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      const double phi = 2 * pi * i / along, theta = 2 * pi * j / around;
      const Vec3d outward{std::cos(phi), std::sin(phi), 0};
      const Vec3d normal = outward * std::cos(theta) + Vec3d{0, 0, std::sin(theta)};
      shape.points.push_back(outward * major + normal * minor);
      shape.normals.push_back(normal);
      const auto index = [&](int di, int dj) { return std::uint32_t((i + di) % along * around + (j + dj) % around); };
      shape.triangles.push_back({index(0, 0), index(1, 0), index(1, 1)});
      shape.triangles.push_back({index(0, 0), index(1, 1), index(0, 1)});
    }
  }
  return shape;
}

/// Toroidal stream with a swing of the poloidal one, and a chain of travelling cells that reverses it here and there.
SampleField torus_flow(double time) {
  const double phase = 2 * pi * time;
  return [phase](const Vec3d& p, const Vec3d& n) {
    const double phi = std::atan2(p.y, p.x), ring = std::hypot(p.x, p.y);
    const double theta = std::atan2(p.z, ring - major);
    const Vec3d along{-p.y / ring, p.x / ring, 0};
    const Vec3d around = cross(n, along);
    const double wave = 3 * phi - phase;
    const double toroidal = 0.55 + 0.45 * std::cos(theta) + 0.85 * std::sin(wave) * std::sin(theta + 0.5) +
                            0.25 * std::cos(5 * phi + phase) * std::cos(2 * theta);
    const double poloidal = 0.15 + 0.45 * std::sin(phase) + 0.8 * std::cos(wave) * std::cos(theta - 0.3) -
                            0.3 * std::sin(2 * phi + phase + theta);
    return along * toroidal + around * poloidal;
  };
}

}  // namespace

SampleDefinition torus_sample() {
  return {{"torus", "flow that winds around a torus, with helicity that changes with time"},
          200,
          6,
          20,
          torus_shape,
          torus_flow};
}

}  // namespace nacre
