// Nacre: analytic tangential vector fields, for surfaces that come without one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "compute/device/among_all.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/surface_share.hpp"

namespace nacre {
namespace {

struct Box {
  Vec3d low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
  Vec3d centre() const { return low + (high - low) * 0.5; }
};

Box bounding_box(const PreparedSurface& surface) {
  Box box;
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      box.low = min(box.low, surface.points[t[k]]);
      box.high = max(box.high, surface.points[t[k]]);
    }
  return box;
}

/// One normal per point: the area-weighted mean over its corners, zero on points without triangle.
std::vector<Vec3d> normals_of_points(const PreparedSurface& surface) {
  std::vector<Vec3d> normals(surface.points.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    const Vec3d a = surface.points[t.a];
    const double area = length(cross(surface.points[t.b] - a, surface.points[t.c] - a));
    for (int k = 0; k < 3; ++k) normals[t[k]] += Vec3d(surface.corner_normals[3 * i + k]) * area;
  }
  for (Vec3d& n : normals) n = normalized(n);
  return normals;
}

/// The gradient of a sum of travelling waves (sources, sinks, saddles) plus an ABC flow (vortices). Over space each
/// component has mean square 1/2, so that the two tangential ones together have about 1. `q` spans about -1..1.
Vec3d swirl(const Vec3d& q, double t) {
  constexpr double pi = std::numbers::pi;
  const double phase = 2 * pi * t;
  const Vec3d a = q * (0.9 * pi) + Vec3d(0.3, 1.1, 2.0);
  const Vec3d b = q * (0.7 * pi) + Vec3d(1.7, 0.4, 2.9);
  const Vec3d sources(std::sin(b.x + phase), std::sin(b.y - phase), std::sin(b.z + phase));
  const double turn = 0.6 * std::sin(phase);
  const Vec3d vortices(std::sin(a.z + turn) + std::cos(a.y), std::sin(a.x) + std::cos(a.z + turn),
                       std::sin(a.y - turn) + std::cos(a.x));
  return sources * std::sqrt(0.5) + vortices * 0.5;
}

}  // namespace

std::vector<std::string> analytic_vector_names() { return {"@swirl", "@rotation"}; }

std::vector<Vec3f> analytic_vectors(const std::string& name, const PreparedSurface& surface, double t,
                                    const Share* share) {
  const bool is_swirl = name == "@swirl";
  if (!is_swirl && name != "@rotation")
    throw Error("there is no analytic field " + name, "", "the fields are @swirl and @rotation");
  Ranks* ranks = share ? share->ranks : nullptr;
  Box box = bounding_box(surface);
  extremes_of_all(ranks, {&box.low.x, 3}, {&box.high.x, 3});
  const Vec3d centre = box.centre(), size = box.high - box.low;
  const double half = 0.5 * std::max({size.x, size.y, size.z});
  const std::vector<Vec3d> normals = normals_of_points(surface);

  std::vector<Vec3f> vectors(surface.points.size());
  double radius = 0;
  for (std::size_t p = 0; p < vectors.size(); ++p)
    if (is_counted(share, p) && dot(normals[p], normals[p]) > 0)
      radius = std::max(radius, std::hypot(surface.points[p].x - centre.x, surface.points[p].y - centre.y));
  extremes_of_all(ranks, {}, {&radius, 1});
  for (std::size_t p = 0; p < vectors.size(); ++p) {
    const Vec3d n = normals[p];
    if (dot(n, n) == 0) continue;
    const Vec3d d = surface.points[p] - centre;
    const Vec3d v = is_swirl ? swirl(d / half, t) : radius > 0 ? Vec3d(-d.y, d.x, 0) / radius : Vec3d{};
    vectors[p] = Vec3f(v - dot(v, n) * n);
  }
  return vectors;
}

}  // namespace nacre
