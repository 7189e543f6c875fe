// Nacre: lines along a tangential vector field on triangles; the separatrices of its saddles.
#include "compute/topology/surface_lines.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace nacre {
namespace {

constexpr int most_rounds = 6;  ///< through one triangle

}  // namespace

LineTracer::LineTracer(const TangentField& field, std::span<const CriticalPoint> points, double longest)
    : field_(field), walk_(field), points_(points), longest_(longest), near_(field.triangles(), none) {
  for (std::uint32_t i = 0; i < points.size(); ++i) {  // sources and sinks: also the triangles around
    if (points[i].index < 0) continue;
    const std::uint32_t t = points[i].triangle;
    for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
      for (std::uint32_t at = c; at != none;) {
        near_[at / 3] = i;
        at = field.twin(TangentField::previous(at));
        if (at == c) break;
      }
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) near_[points[i].triangle] = i;
}

Vec2d LineTracer::direction(const SurfacePosition& at, bool forward) const {
  const std::array<Vec2d, 3> p = walk_.corners(at.triangle), v = field_.corner_vectors(at.triangle);
  const double whole = cross(p[1], p[2]);
  if (whole == 0) return {};
  const double b = cross(at.x, p[2]) / whole, c = cross(p[1], at.x) / whole;
  return normalized((v[0] * (1 - b - c) + v[1] * b + v[2] * c) * (forward ? 1 : -1));
}

void LineTracer::follow(SurfacePosition at, bool forward, SurfaceLine& line, const MayGoOn& may) const {
  line.forward = forward;
  std::unordered_map<std::uint32_t, int> rounds;
  double gone = 0;
  std::uint32_t last = at.triangle;
  bool left = line.from == none;  // the critical point where it began
  for (;;) {
    left = left || near_[at.triangle] != line.from;
    const std::uint32_t point = near_[at.triangle];
    if (left && point != none && points_[point].kind != CriticalKind::centre) {
      const bool goes_out = points_[point].first.real() + points_[point].second.real() > 0;
      if (points_[point].index < 0 || goes_out != forward) {
        line.points.push_back(points_[point].position);
        line.triangles.push_back(points_[point].triangle);
        line.to = point;
        line.end = LineEnd::critical_point;
        return;
      }
    }
    at.along = direction(at, forward);
    if (at.along.x == 0 && at.along.y == 0) return;
    const double step = walk_.step_in(at.triangle);
    SurfacePosition middle = at;
    if (walk_.go(middle, 0.5 * step).rim == none) {
      const Vec2d there = direction(middle, forward);
      if (there.x != 0 || there.y != 0) at.along = normalized(turned_by(at.along, turned_back_by(there, middle.along)));
    }
    gone += step;
    const std::size_t before = line.points.size();
    const bool inside = walk_.go(at, step, &line).rim == none;
    if (may && !may(line, gone)) {
      line.points.resize(before);
      line.triangles.resize(before);
      line.end = LineEnd::stopped;
      return;
    }
    if (!inside) {
      line.end = LineEnd::rim;
      return;
    }
    if (at.triangle != last && ++rounds[last] > most_rounds) gone = longest_;
    last = at.triangle;
    if (!(gone < longest_)) {
      line.end = LineEnd::circling;
      return;
    }
  }
}

SurfaceLine LineTracer::trace(std::uint32_t triangle, const Vec3d& weights, bool forward, const MayGoOn& may) const {
  const std::array<Vec2d, 3> p = walk_.corners(triangle);
  SurfacePosition at{triangle, p[0] * weights.x + p[1] * weights.y + p[2] * weights.z, {}};
  SurfaceLine line;
  line.points.push_back(walk_.in_space(triangle, at.x));
  line.triangles.push_back(triangle);
  follow(at, forward, line, may);
  return line;
}

LineTracer::Beside LineTracer::beside(std::uint32_t triangle, const Vec3d& from, double distance) const {
  SurfacePosition at{triangle, walk_.in_plane(triangle, from), {}};
  const Vec2d flow = direction(at, true);
  if (flow.x == 0 && flow.y == 0) return {};
  at.along = distance > 0 ? Vec2d{-flow.y, flow.x} : Vec2d{flow.y, -flow.x};
  if (walk_.go(at, std::fabs(distance)).rim != none) return {};
  return {at.triangle, walk_.weights(at.triangle, at.x), walk_.in_space(at.triangle, at.x)};
}

double LineTracer::speed(std::uint32_t triangle, const Vec3d& at) const {
  const Vec3d w = walk_.weights(triangle, walk_.in_plane(triangle, at));
  const std::array<Vec2d, 3> v = field_.corner_vectors(triangle);
  const Vec2d sum = v[0] * w.x + v[1] * w.y + v[2] * w.z;
  return std::hypot(sum.x, sum.y);
}

SurfaceLine LineTracer::leave(std::uint32_t saddle, const Vec3d& axis, bool forward) const {
  const CriticalPoint& point = points_[saddle];
  const std::array<Vec2d, 3> p = walk_.corners(point.triangle);
  const auto& axes = walk_.frame(point.triangle);
  SurfacePosition at{point.triangle, p[0] * point.weights.x + p[1] * point.weights.y + p[2] * point.weights.z,
                     normalized(Vec2d{dot(axis, axes[0]), dot(axis, axes[1])})};
  SurfaceLine line;
  line.from = saddle;
  line.forward = forward;
  line.points.push_back(walk_.in_space(at.triangle, at.x));
  line.triangles.push_back(at.triangle);
  if (walk_.go(at, 2 * walk_.step_in(at.triangle), &line).rim != none) {
    line.end = LineEnd::rim;
    return line;
  }
  follow(at, forward, line, {});
  return line;
}

std::vector<SurfaceLine> separatrices(const TangentField& field, std::span<const CriticalPoint> points) {
  std::vector<SurfaceLine> lines;
  if (points.empty()) return lines;
  const LineTracer tracer(field, points, 4 * field.diagonal());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (points[i].kind != CriticalKind::saddle) continue;
    for (const bool forward : {true, false})
      for (const double side : {1.0, -1.0})
        lines.push_back(tracer.leave(i, (forward ? points[i].first_axis : points[i].second_axis) * side, forward));
  }
  return lines;
}

}  // namespace nacre
