// Nacre: built-in sample that moves: a closed vessel that beats and wrings itself, with vortices on it.
#include <numbers>

#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;

/// Narrow and long at time 1/4, wide and short at 3/4; its ends turn against each other meanwhile.
Vec3d pulse_position(const Vec3d& p, double time) {
  const double beat = std::sin(2 * pi * time), twist = 0.5 * beat * p.z;
  const double width = (1 - 0.16 * beat) * (1 - 0.18 * p.z), c = std::cos(twist) * width, s = std::sin(twist) * width;
  return {c * p.x - s * p.y, s * p.x + c * p.y, 1.25 * (1 + 0.08 * beat) * p.z};
}

SampleField pulse_flow(double time) {
  const double phase = 2 * pi * time;
  const std::vector<Eddy> eddies{
      {normalized(Vec3d(1, -0.6, 0.4)), 0.55, 1.5, 0.2 * std::sin(phase)},
      {normalized(Vec3d(0.1, -1, -0.5)), 0.5, -1.4, 0.2},
      {normalized(Vec3d(-0.8, -0.7, 0.4)), 0.5, 1.4, -0.2},
      {normalized(Vec3d(-0.9, 0.5, -0.4)), 0.55, -1.5, 0.2 * std::cos(phase)},
      {normalized(Vec3d(0.1, 1, 0.4)), 0.5, 1.4, -0.2},
      {normalized(Vec3d(0.9, 0.6, -0.5)), 0.5, -1.3, -0.2},
  };
  return [eddies, phase](const Vec3d& p, const Vec3d& n) {
    return cross(Vec3d{0, 0.3 * std::sin(phase), 0.5}, p) + sum_of(eddies, p, n);
  };
}

}  // namespace

SampleDefinition pulse_sample() {
  return {{"pulse", "a vessel that beats and wrings itself, with vortices on it: the surface moves"},
          120,
          6,
          20,
          unit_sphere_shape,
          pulse_flow,
          pulse_position};
}

}  // namespace nacre
