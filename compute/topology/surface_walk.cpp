// Nacre: straight ways over the triangles of a surface.
#include "compute/topology/surface_walk.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {

SurfaceWalk::SurfaceWalk(const TangentField& field) : field_(field) {
  for (std::uint32_t t = 0; t < field.triangles(); ++t) {
    frame_.push_back(field.frame(t));
    const Vec3d a = field.corner_point(3 * t), b = field.corner_point(3 * t + 1) - a,
                c = field.corner_point(3 * t + 2) - a;
    second_.push_back({dot(b, frame_[t][0]), 0});
    third_.push_back({dot(c, frame_[t][0]), dot(c, frame_[t][1])});
    step_.push_back(0.4 * std::sqrt(std::fabs(cross(second_[t], third_[t]))));
  }
}

Vec3d SurfaceWalk::in_space(std::uint32_t t, const Vec2d& x) const {
  return field_.corner_point(3 * t) + frame_[t][0] * x.x + frame_[t][1] * x.y;
}

Vec2d SurfaceWalk::in_plane(std::uint32_t t, const Vec3d& p) const {
  const Vec3d d = p - field_.corner_point(3 * t);
  return {dot(d, frame_[t][0]), dot(d, frame_[t][1])};
}

Vec3d SurfaceWalk::weights(std::uint32_t t, const Vec2d& x) const {
  const Vec2d &p = second_[t], &q = third_[t];
  const double whole = cross(p, q);
  if (whole == 0) return {1, 0, 0};
  const double b = std::clamp(cross(x, q) / whole, 0.0, 1.0), c = std::clamp(cross(p, x) / whole, 0.0, 1.0 - b);
  return {1 - b - c, b, c};
}

SurfaceWalk::Rest SurfaceWalk::go(SurfacePosition& at, double distance, SurfacePath* path,
                                  std::uint32_t not_across) const {
  std::uint32_t came = not_across;  // the edge that is crossed back by nobody
  for (int crossings = 0; crossings < 1000; ++crossings) {
    const std::array<Vec2d, 3> p = corners(at.triangle);
    double nearest = distance;
    std::uint32_t out = none;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t h = 3 * at.triangle + k;
      if (h == came) continue;
      const Vec2d edge = p[(k + 1) % 3] - p[k];
      const double leaving = cross(at.along, edge);  // the inside is on the left
      if (!(leaving > 0)) continue;
      const double until = std::max(0.0, cross(p[k] - at.x, edge) / leaving);
      if (until < nearest) nearest = until, out = h;
    }
    at.x = at.x + at.along * nearest;
    if (path) {
      path->points.push_back(in_space(at.triangle, at.x));
      path->triangles.push_back(at.triangle);
    }
    if (out == none) return {};
    distance -= nearest;
    const std::uint32_t other = field_.twin(out);
    if (other == none) return {distance, out};
    const std::uint32_t k = out % 3, j = other % 3;
    const Vec2d edge = normalized(p[(k + 1) % 3] - p[k]);
    const std::array<Vec2d, 3> q = corners(other / 3);
    const Vec2d back = normalized(q[j] - q[(j + 1) % 3]);  // the same edge, in the same direction, over there
    const double whole = std::sqrt(dot(p[(k + 1) % 3] - p[k], p[(k + 1) % 3] - p[k]));
    const double share = whole > 0 ? std::clamp(dot(at.x - p[k], edge) / whole, 0.0, 1.0) : 0;
    at.x = q[(j + 1) % 3] + (q[j] - q[(j + 1) % 3]) * share;
    at.along = turned_by(turned_back_by(at.along, edge), back);
    at.triangle = other / 3;
    came = other;
  }
  return {};
}

}  // namespace nacre
