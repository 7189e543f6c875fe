// Nacre: particles on simple surfaces, for the tests of stars.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "compute/meshing/star_mesh.hpp"
#include "compute/meshing/topology.hpp"

namespace nacre::test {

/// Particles that own what StarParticles shows.
struct Cloud {
  std::vector<Float4> position, direction;
  std::vector<Junction> junction;
  std::vector<JunctionGradients> gradient;  // of all; those off junctions are not read

  /// On the surface between materials 0 and 1; `normal` points out of 1.
  void add(const Vec3d& p, double h, const Vec3d& normal) { add(p, h, normal, Junction(0, 1)); }
  void add(const Vec3d& p, double h, const Vec3d& normal, const Junction& j, const JunctionGradients& g = {}) {
    position.push_back({float(p.x), float(p.y), float(p.z), float(h)});
    direction.push_back({float(normal.x), float(normal.y), float(normal.z), 0});
    junction.push_back(j);
    gradient.push_back(g);
  }
  StarParticles view() const {
    on_rims_.clear();
    for (std::size_t i = 0; i < junction.size(); ++i)
      if (junction[i].order() < 2) on_rims_.push_back(gradient[i]);
    return {position, direction, junction, on_rims_};
  }

  SurfaceMesh mesh(const StarMesh& made) const {
    SurfaceMesh mesh;
    for (const Float4& p : position) mesh.points.push_back({p.x, p.y, p.z});
    mesh.triangles = made.triangles;
    mesh.materials = made.materials;
    return mesh;
  }
  TopologyReport topology(const StarMesh& made, int materials = 2) const {
    return check_topology(mesh(made), materials);
  }

 private:
  mutable std::vector<JunctionGradients> on_rims_;
};

inline double spacing(double radius, std::size_t count) {
  return radius * std::sqrt(4 * M_PI / (double(count) * std::sqrt(0.75)));
}

/// Points of a sphere around the origin as a cloud of even size.
inline Cloud sphere(const std::vector<Vec3d>& directions, double radius) {
  Cloud cloud;
  for (const Vec3d& d : directions)
    cloud.add(normalized(d) * radius, spacing(radius, directions.size()), normalized(d));
  return cloud;
}

inline std::vector<Vec3d> spiral(int count) {
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), t = i * 2.399963229728653;
    points.push_back({r * std::cos(t), r * std::sin(t), z});
  }
  return points;
}

inline std::vector<Vec3d> random_directions(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> points;
  while (int(points.size()) < count) {
    Vec3d p(normal(generator), normal(generator), normal(generator));
    p = normalized(p);
    if (std::all_of(points.begin(), points.end(),
                    [&](const Vec3d& q) { return length(p - q) > 1.2 / std::sqrt(count); }))
      points.push_back(p);
  }
  return points;
}

/// A ball that the plane z = 0 cuts into materials 1 (above) and 2.
inline Cloud halves(double radius, double h) {
  Cloud cloud;
  const int rim = int(2 * M_PI * radius / h);
  for (int i = 0; i < rim; ++i) {
    const Vec3d out(std::cos(2 * M_PI * i / rim), std::sin(2 * M_PI * i / rim), 0);
    JunctionGradients g;
    g.from_first[0] = Vec3f(out - Vec3d(0, 0, 0.5)), g.from_first[1] = Vec3f(out + Vec3d(0, 0, 0.5));
    cloud.add(out * radius, h, Vec3d(), Junction(0, 1, 2), g);
  }
  for (const Vec3d& d : spiral(int(4 * M_PI * radius * radius / (h * h * std::sqrt(0.75)))))
    if (std::abs(d.z) * radius > 0.6 * h) cloud.add(d * radius, h, d, Junction(0, d.z > 0 ? 1 : 2));
  const int n = int(radius / h) + 2;
  for (int j = -n; j <= n; ++j)
    for (int i = -2 * n; i <= 2 * n; ++i) {
      const Vec3d p(h * (i + 0.5 * (j & 1)), h * std::sqrt(0.75) * j, 0);
      if (length(p) < radius - 0.6 * h) cloud.add(p, h, {0, 0, 1}, Junction(1, 2));
    }
  return cloud;
}

}  // namespace nacre::test
