// Nacre: bodies whose surfaces are known exactly, and what is asked of their meshes.
#pragma once

#include "tests/evidence/mesh_measures.hpp"

namespace nacre::test {

inline const Vec3d middle(17.3, 16.8, 17.1);  // on no voxel and no face of one
inline constexpr Int3 cube{35, 35, 35};

inline MeshRun mesh_of(const MeshVolume& volume, const MeshParameters& parameters = {}) {
  const auto device = make_cpu_device();
  return run_mesh(*device, volume, parameters);
}

inline std::vector<Vec3d> on_sphere(const Vec3d& centre, double radius, int count = 1500,
                                    const std::function<bool(const Vec3d&)>& keep = {}) {
  std::vector<Vec3d> points;
  for (const Vec3d& d : even_directions(count))
    if (const Vec3d p = centre + d * radius; !keep || keep(p)) points.push_back(p);
  return points;
}

/// Signed distance to an ellipsoid, positive inside: the foot on it lies at s_i^2 x_i / (s_i^2 + t) with the largest t
/// that puts it there.
inline PlaceFunction ellipsoid(const Vec3d& centre, const Vec3d& semi) {
  return [=](const Vec3d& p) {
    const Vec3d x = p - centre;
    const auto foot = [&](double t) {
      Vec3d q;
      for (int k = 0; k < 3; ++k) q[k] = semi[k] * semi[k] * x[k] / (semi[k] * semi[k] + t);
      return q;
    };
    const auto level = [&](const Vec3d& q) {
      return dot(q, Vec3d(q.x / (semi.x * semi.x), q.y / (semi.y * semi.y), q.z / (semi.z * semi.z)));
    };
    const double least = std::min({semi.x, semi.y, semi.z});
    double low = -least * least + 1e-9, high = 40 * 40;
    for (int k = 0; k < 80; ++k) {
      const double t = 0.5 * (low + high);
      (level(foot(t)) > 1 ? low : high) = t;
    }
    const double away = length(foot(0.5 * (low + high)) - x);
    return level(x) < 1 ? away : -away;
  };
}

inline PlaceFunction torus(const Vec3d& centre, double major, double minor) {
  return [=](const Vec3d& p) {
    const Vec3d r = p - centre;
    return minor - std::hypot(std::hypot(r.x, r.y) - major, r.z);
  };
}

inline std::vector<Vec3d> on_torus(const Vec3d& centre, double major, double minor) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 25; ++j) {
      const double u = i * M_PI / 30, v = j * 2 * M_PI / 25, r = major + minor * std::cos(v);
      points.push_back(centre + Vec3d(r * std::cos(u), r * std::sin(u), minor * std::sin(v)));
    }
  return points;
}

/// Balls that keep their sides of the planes between them; the outside is where all functions are negative.
inline std::vector<PlaceFunction> balls(const std::vector<Vec3d>& centres, double radius) {
  std::vector<PlaceFunction> functions{[](const Vec3d&) { return 0.0; }};
  for (const Vec3d& c : centres) functions.push_back(ball(c, radius));
  return functions;
}

/// The interfaces of `balls`: pieces of spheres and of the planes between equal ones.
inline std::vector<ExactInterface> interfaces_of(const std::vector<Vec3d>& centres, double radius) {
  std::vector<ExactInterface> interfaces;
  const auto nearest = [=](const Vec3d& p, std::size_t k) {
    return std::all_of(centres.begin(), centres.end(),
                       [&](const Vec3d& c) { return length(p - centres[k]) <= length(p - c) + 1e-9; });
  };
  for (std::size_t k = 0; k < centres.size(); ++k) {
    const auto own = [=](const Vec3d& p) { return nearest(p, k); };
    interfaces.push_back({0, std::uint16_t(k + 1), ball(centres[k], radius), on_sphere(centres[k], radius, 1500, own)});
    for (std::size_t l = k + 1; l < centres.size(); ++l) {
      const Vec3d n = normalized(centres[l] - centres[k]), m = (centres[k] + centres[l]) / 2.0;
      const Vec3d s = normalized(cross(n, Vec3d(0.3, 0.2, 1))), t = cross(n, s);
      std::vector<Vec3d> points;
      for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
          if (const Vec3d p = m + s * (i * 0.05 * radius) + t * (j * 0.05 * radius);
              length(p - centres[k]) < radius && nearest(p, k) && nearest(p, l))
            points.push_back(p);
      interfaces.push_back(
          {std::uint16_t(k + 1), std::uint16_t(l + 1), [=](const Vec3d& p) { return dot(p - m, n); }, points});
    }
  }
  return interfaces;
}

/// The interfaces of three shells one in another, by number from the outside to the core.
inline std::vector<ExactInterface> nested_shells() {
  std::vector<ExactInterface> interfaces;
  for (const double r : {12.4, 9.1, 6.2}) {
    const auto outer = std::uint16_t(interfaces.size());
    interfaces.push_back({outer, std::uint16_t(outer + 1), ball(middle, r), on_sphere(middle, r)});
  }
  return interfaces;
}

}  // namespace nacre::test
