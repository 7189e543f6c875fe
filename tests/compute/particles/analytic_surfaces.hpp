// Nacre: surfaces with a formula, for solvers to work on.
#pragma once

#include <cmath>
#include <vector>

#include "compute/device/random.hpp"
#include "compute/field/interface.hpp"
#include "compute/math/vec.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre::test {

/// Spheres about the origin; interface k is the one with radius[k]. One size everywhere.
struct Spheres {
  float radius[4];
  float h;
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const {
    direction = normalized(p);
    on = direction * radius[interface];
    return dot(on - p, on - p) <= reach * reach;
  }
  NACRE_HD float size(const Vec3f&) const { return h; }
};

/// Interface 0: the disc |p| <= radius in the plane z = 0. Interface 1: its rim.
struct Disc {
  float radius, h;
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const float scale = interface == 1 ? radius / r : r > radius ? radius / r : 1;
    on = {p.x * scale, p.y * scale, 0};
    direction = interface == 1 ? Vec3f(-p.y, p.x, 0) / r : Vec3f(0, 0, 1);
    return dot(on - p, on - p) <= reach * reach;
  }
  NACRE_HD float size(const Vec3f&) const { return h; }
};

/// A torus about the z axis; h grows from `least` at y = -(major + minor) with slope `grading`.
struct Torus {
  float major, minor, least, grading;
  NACRE_HD bool project(std::uint32_t, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const {
    const Vec3f ring = normalized(Vec3f(p.x, p.y, 0)) * major;
    direction = normalized(p - ring);
    on = ring + direction * minor;
    return dot(on - p, on - p) <= reach * reach;
  }
  NACRE_HD float size(const Vec3f& p) const { return least + grading * (p.y + major + minor); }
};

/// The one-interface table that most tests need: `count` surfaces between materials k and k + 1.
inline std::vector<Junction> plain_table(int count) {
  std::vector<Junction> table;
  for (int k = 0; k < count; ++k) table.emplace_back(std::uint32_t(k), std::uint32_t(k + 1));
  return table;
}

/// Random points on a sphere about the origin: uniform, without any order.
inline std::vector<Vec3f> scattered_on_sphere(float radius, int count, std::uint32_t seed) {
  std::vector<Vec3f> points;
  for (int k = 0; k < count; ++k) {
    const float z = 2 * uniform_random(seed, k, 0) - 1, a = 2 * pi * uniform_random(seed, k, 1),
                r = std::sqrt(1 - z * z);
    points.push_back(Vec3f(r * std::cos(a), r * std::sin(a), z) * radius);
  }
  return points;
}

/// Particles at host points, projected; those before `fixed` are fixed.
struct Seeds {
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> interface;
  std::int64_t fixed = 0;
};

template <class Backend, class Surface>
ParticleSet make_particles(Executor<Backend>& exec, const Surface& surface, const Seeds& seeds, std::int64_t capacity) {
  ParticleSet set = make_particle_set(exec, capacity);
  std::vector<Float4> position, direction;
  for (std::size_t k = 0; k < seeds.points.size(); ++k) {
    Vec3f on, d;
    surface.project(seeds.interface[k], seeds.points[k], 1e9f, on, d);
    position.push_back({on.x, on.y, on.z, surface.size(on)});
    direction.push_back({d.x, d.y, d.z, 0});
  }
  set.fixed = seeds.fixed;
  set.count = std::int64_t(position.size());
  set.position.upload(position);
  set.direction.upload(direction);
  set.interface.upload(seeds.interface);
  return set;
}

}  // namespace nacre::test
