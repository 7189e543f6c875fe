// Nacre: particles that are carried along a surface by vectors that change in time.
#include "compute/transport/pathlines.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "compute/transport/flow_map.hpp"

namespace nacre {

std::vector<Pathlines::Corners> Pathlines::in_frames(std::span<const Vec3f> vectors) const {
  std::vector<Corners> result(surface_.triangles());
  tbb::parallel_for(std::size_t(0), result.size(), [&](std::size_t t) {
    const auto& [x, y, normal] = walk_.frame(std::uint32_t(t));
    for (int k = 0; k < 3; ++k) {
      const Vec3d& n = surface_.normal(surface_.vertex(std::uint32_t(3 * t) + std::uint32_t(k)));
      Vec3d v(vectors[surface_.triangle(t)[k]]);
      if (!is_finite(v)) v = {};
      v = turned(v - n * dot(v, n), n, normal);
      result[t][std::size_t(k)] = Vec2d{dot(v, x), dot(v, y)} * duration_;
    }
  });
  return result;
}

void Pathlines::enter(double duration, std::span<const Vec3f> first, std::span<const Vec3f> last) {
  duration_ = duration;
  first_ = in_frames(first);
  last_ = in_frames(last);
}

Vec2d Pathlines::vector_at(std::uint32_t corner, double share) const {
  const Vec2d &a = first_[corner / 3][corner % 3], &b = last_[corner / 3][corner % 3];
  return a + (b - a) * share;
}

Vec2d Pathlines::velocity(const SurfacePosition& at, double share) const {
  const Vec3d w = walk_.weights(at.triangle, at.x);
  const std::uint32_t c = 3 * at.triangle;
  return vector_at(c, share) * w.x + vector_at(c + 1, share) * w.y + vector_at(c + 2, share) * w.z;
}

bool Pathlines::goes_out(std::uint32_t rim, double share) const {
  const auto p = walk_.corners(rim / 3);
  const Vec2d edge = normalized(p[TangentField::next(rim) % 3] - p[rim % 3]);
  const Vec2d a = vector_at(rim, share), b = vector_at(TangentField::next(rim), share);
  return cross(a + b, edge) > outflow_share * (length(a) + length(b));  // the inside is on the left
}

/// Straight on, and along rims that are not left. Whether it went straight on all the way.
bool Pathlines::move(SurfaceParticle& particle, double distance, double share) const {
  SurfacePosition& at = particle.at;
  std::uint32_t along_rim = none;
  for (int rims = 0; rims < 64 && distance > 0; ++rims) {
    const SurfaceWalk::Rest rest = walk_.go(at, distance, nullptr, along_rim);
    if (rest.rim == none) return rims == 0;
    particle.left = goes_out(rest.rim, share);
    if (particle.left) return false;
    const auto p = walk_.corners(at.triangle);
    const Vec2d edge = normalized(p[TangentField::next(rest.rim) % 3] - p[rest.rim % 3]);
    const double part = dot(at.along, edge);
    at.along = edge * (part < 0 ? -1 : 1);
    if (std::fabs(part) < 1e-3) return false;  // against a wall
    distance = rest.distance * std::fabs(part);
    along_rim = rest.rim;
  }
  return distance == 0;
}

void Pathlines::carry(SurfaceParticle& particle) const {
  for (double s = 0; s < 1 && !particle.left;) {
    SurfacePosition& at = particle.at;
    const Vec2d now = velocity(at, s), later = velocity(at, 1);
    const double fastest = std::max(length(now), length(later));
    if (fastest == 0) return;  // vectors are linear in time: it rests
    double step = std::min(1 - s, walk_.step_in(at.triangle) / fastest);
    if (!(s + step > s)) return;  // no size to go by
    if (1 - s - step < 1e-9) step = 1 - s;
    at.along = length(now) > 0 ? normalized(now) : normalized(later);
    SurfaceParticle middle = particle;
    const bool straight = move(middle, 0.5 * step * length(now), s);
    if (middle.left) {
      particle = middle;
      return;
    }
    Vec2d there = velocity(middle.at, s + 0.5 * step);
    if (!straight) there = middle.at.along * std::max(0.0, dot(there, middle.at.along));
    const double speed = length(there);
    if (speed > 0) {
      at.along = normalized(turned_by(at.along, turned_back_by(there * (1 / speed), middle.at.along)));
      move(particle, step * speed, s + 0.5 * step);
    }
    s += step;
  }
}

SurfaceParticle Pathlines::at_vertex(std::span<const std::uint32_t> fan) const {
  SurfaceParticle particle;
  double best = -1e300;
  for (const std::uint32_t c : fan) {
    const auto p = walk_.corners(c / 3);
    const Vec2d& here = p[c % 3];
    Vec2d v = vector_at(c, 0);
    if (v.x == 0 && v.y == 0) v = vector_at(c, 1);
    v = normalized(v);
    const double inside = std::min(cross(normalized(p[TangentField::next(c) % 3] - here), v),
                                   cross(v, normalized(p[TangentField::previous(c) % 3] - here)));
    if (inside > best) best = inside, particle.at = {c / 3, here, {1, 0}};
  }
  return particle;
}

}  // namespace nacre
