// Nacre: built-in samples on the unit sphere: drifting vortices, and a rigid rotation.
#include <numbers>

#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;

/// A cube whose faces are divided into equal angles, blown up to the sphere: no poles, triangles of nearly equal size.
SampleShape sphere_shape(int detail) {
  const int n = std::max(2, int(std::lround(detail * pi / 4)));
  LatticeBox box = lattice_box(n, n, n);
  SampleShape shape;
  shape.triangles = std::move(box.triangles);
  for (const Int3& p : box.points) {
    const auto warp = [&](int i) { return std::tan(pi / 4 * (2.0 * i / n - 1)); };
    shape.points.push_back(normalized(Vec3d{warp(p.x), warp(p.y), warp(p.z)}));
  }
  shape.normals = shape.points;
  return shape;
}

/// An eddy that circles about the direction `home` once (or `turns` times) a period, at `reach` from it.
Eddy circling(Vec3d home, double reach, double turns, double time, Eddy eddy) {
  home = normalized(home);
  const Vec3d side = normalized(cross(home, std::abs(home.z) < 0.8 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}));
  const double angle = 2 * pi * turns * time;
  eddy.centre = normalized(home + (side * std::cos(angle) + cross(home, side) * std::sin(angle)) * reach);
  return eddy;
}

SampleField sphere_flow(double time) {
  const std::vector<Eddy> eddies{
      circling({1.0, -0.7, 0.5}, 0.25, 1, time, {{}, 0.55, 1.5, 0.15}),
      circling({0.2, -1.0, -0.5}, 0.22, -1, time, {{}, 0.45, -1.4, 0.1}),
      circling({-0.8, -0.8, 0.4}, 0.25, 1, time, {{}, 0.50, 1.4, -0.25}),
      circling({-1.0, 0.4, -0.4}, 0.22, -1, time, {{}, 0.55, -1.5, 0.2}),
      circling({-0.2, 1.0, 0.5}, 0.25, 1, time, {{}, 0.50, 1.5, -0.2}),
      circling({0.8, 0.7, -0.5}, 0.22, -1, time, {{}, 0.45, -1.3, -0.3}),
      circling({0.1, 0.1, 1.0}, 0.20, -1, time, {{}, 0.45, -1.2, 0.4}),
      circling({0.1, -0.1, -1.0}, 0.20, 1, time, {{}, 0.50, 1.2, -0.4}),
      circling({1.0, 0.1, -0.3}, 0.20, 1, time, {{}, 0.40, 0.2, 0.9}),
  };
  const double sway = 0.4 * std::sin(2 * pi * time);
  return [eddies, sway](const Vec3d& p, const Vec3d& n) {
    const Vec3d drift = cross(Vec3d{sway, -0.2, 0.45}, p);
    return drift + sum_of(eddies, p, n);
  };
}

}  // namespace

SampleShape unit_sphere_shape(int detail) { return sphere_shape(detail); }

SampleDefinition sphere_sample() {
  return {{"sphere", "drifting vortices, sources and sinks on the unit sphere"}, 140, 4, 20, sphere_shape, sphere_flow};
}

SampleDefinition sphere_rotation_sample() {
  return {{"sphere-rotation", "steady rigid rotation of the unit sphere about z, 1 radian per unit of time"},
          140,
          4,
          1,
          sphere_shape,
          [](double) -> SampleField { return [](const Vec3d& p, const Vec3d&) {
                                        return Vec3d{-p.y, p.x, 0};
                                      }; }};
}

}  // namespace nacre
