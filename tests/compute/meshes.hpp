// Nacre: small meshes in units of cells for the tests of the numerics.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/math/vec.hpp"

namespace nacre::test {

struct Mesh {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;

  Corners corners(std::size_t t) const {
    return {points[triangles[t].a], points[triangles[t].b], points[triangles[t].c]};
  }
  void add(const Corners& t) {
    const auto n = std::uint32_t(points.size());
    points.insert(points.end(), {t.a, t.b, t.c});
    triangles.push_back({n, n + 1, n + 2});
  }
  void add(const Mesh& other) {
    for (std::size_t t = 0; t < other.triangles.size(); ++t) add(other.corners(t));
  }
};

/// The images of `nu` x `nv` squares over the unit square, two triangles each (those that collapse are left out).
template <class Map>
Mesh mapped_square(int nu, int nv, const Map& map) {
  Mesh mesh;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.points.push_back(map(double(i) / nu, double(j) / nv));
  auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3d n = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    if (length(n) > 1e-12) mesh.triangles.push_back({a, b, c});
  };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const auto a = std::uint32_t(j * (nu + 1) + i), d = a + std::uint32_t(nu + 1);
      add(a, a + 1, d);
      add(a + 1, d + 1, d);
    }
  return mesh;
}

inline constexpr double pi = 3.14159265358979323846;

inline Mesh sphere(const Vec3d& centre, double radius, int n) {
  return mapped_square(2 * n, n, [&](double u, double v) {
    const double a = 2 * pi * u, b = pi * v;
    return centre + Vec3d(std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), -std::cos(b)) * radius;
  });
}

inline Mesh torus(const Vec3d& centre, double ring, double tube, int n) {
  return mapped_square(2 * n, n, [&](double u, double v) {
    const double a = 2 * pi * u, b = 2 * pi * v, r = ring + tube * std::cos(b);
    return centre + Vec3d(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
  });
}

/// The parallelogram at `corner` with sides `u`, `v`, cut into 2 n^2 triangles.
inline Mesh sheet(const Vec3d& corner, const Vec3d& u, const Vec3d& v, int n) {
  return mapped_square(n, n, [&](double s, double t) { return corner + u * s + v * t; });
}

inline Mesh box(const Vec3d& low, const Vec3d& high, int n) {
  const Vec3d d = high - low, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
  Mesh mesh;
  for (const Mesh& face : {sheet(low, y, x, n), sheet(low, x, z, n), sheet(low, z, y, n), sheet(high, -x, -y, n),
                           sheet(high, -z, -x, n), sheet(high, -y, -z, n)})
    mesh.add(face);
  return mesh;
}

/// Numbers in [0, 1), the same on every machine.
class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double operator()() { return double(generator_()) * 0x1p-32; }
  double between(double low, double high) { return low + (high - low) * (*this)(); }
  Vec3d point(double low, double high) {
    const double x = between(low, high), y = between(low, high), z = between(low, high);
    return {x, y, z};
  }

 private:
  std::mt19937 generator_;
};

/// `count` unrelated triangles inside [low, high]^3, with edges of about `size`.
inline Mesh soup(int count, double low, double high, double size, unsigned seed) {
  Random random(seed);
  Mesh mesh;
  for (int t = 0; t < count; ++t) {
    const Vec3d p = random.point(low + size, high - size);
    mesh.add(Corners{p, p + random.point(-size, size), p + random.point(-size, size)});
  }
  return mesh;
}

/// A mesh on a device, until the arena is rewound.
template <class Backend>
MeshView upload(Executor<Backend>& exec, const Mesh& mesh) {
  Arena& arena = exec.arena();
  const std::vector<Vec3f> normals(3 * mesh.triangles.size(), Vec3f(0, 0, 1));
  return {arena.permanent_copy<Vec3d>(mesh.points).data(), arena.permanent_copy<Triangle>(mesh.triangles).data(),
          arena.permanent_copy<Vec3f>(normals).data()};
}

}  // namespace nacre::test
