// Nacre: lines along a tangential vector field on triangles; the separatrices of its saddles.
#include "compute/topology/surface_lines.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace nacre {
namespace {

constexpr int most_rounds = 6;  ///< through one triangle

Vec2d operator+(const Vec2d& a, const Vec2d& b) { return {a.x + b.x, a.y + b.y}; }
Vec2d operator-(const Vec2d& a, const Vec2d& b) { return {a.x - b.x, a.y - b.y}; }
Vec2d operator*(const Vec2d& a, double s) { return {a.x * s, a.y * s}; }
double dot(const Vec2d& a, const Vec2d& b) { return a.x * b.x + a.y * b.y; }
double cross(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }
Vec2d unit(const Vec2d& a) {
  const double n = std::hypot(a.x, a.y);
  return n > 0 ? a * (1 / n) : Vec2d{};
}
/// Both as complex numbers.
Vec2d times(const Vec2d& a, const Vec2d& b) { return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x}; }
Vec2d over(const Vec2d& a, const Vec2d& b) { return {a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y}; }  // b: unit

}  // namespace

LineTracer::LineTracer(const TangentField& field, std::span<const CriticalPoint> points, double longest)
    : field_(field), points_(points), longest_(longest), near_(field.triangles(), none) {
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

std::array<Vec2d, 3> LineTracer::corners(std::uint32_t t) const {
  const auto [x, y, normal] = field_.frame(t);
  const Vec3d a = field_.corner_point(3 * t), b = field_.corner_point(3 * t + 1) - a,
              c = field_.corner_point(3 * t + 2) - a;
  return {Vec2d{0, 0}, Vec2d{nacre::dot(b, x), 0}, Vec2d{nacre::dot(c, x), nacre::dot(c, y)}};
}

Vec3d LineTracer::in_space(std::uint32_t t, const Vec2d& x) const {
  const auto axes = field_.frame(t);
  return field_.corner_point(3 * t) + axes[0] * x.x + axes[1] * x.y;
}

double LineTracer::step_in(std::uint32_t t) const {
  const std::array<Vec2d, 3> p = corners(t);
  return 0.4 * std::sqrt(std::fabs(cross(p[1], p[2])));
}

Vec2d LineTracer::direction(const At& at, bool forward) const {
  const std::array<Vec2d, 3> p = corners(at.triangle), v = field_.corner_vectors(at.triangle);
  const double whole = cross(p[1], p[2]);
  if (whole == 0) return {};
  const double b = cross(at.x, p[2]) / whole, c = cross(p[1], at.x) / whole;
  return unit((v[0] * (1 - b - c) + v[1] * b + v[2] * c) * (forward ? 1 : -1));
}

/// Straight on over edges. False at a rim, where it stops.
bool LineTracer::walk(At& at, double distance, SurfaceLine* path) const {
  std::uint32_t came = none;  // the edge that is crossed back by nobody
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
    if (out == none) return true;
    distance -= nearest;
    const std::uint32_t other = field_.twin(out);
    if (other == none) return false;
    const std::uint32_t k = out % 3, j = other % 3;
    const Vec2d edge = unit(p[(k + 1) % 3] - p[k]);
    const std::array<Vec2d, 3> q = corners(other / 3);
    const Vec2d back = unit(q[j] - q[(j + 1) % 3]);  // the same edge, in the same direction, over there
    const double whole = std::sqrt(dot(p[(k + 1) % 3] - p[k], p[(k + 1) % 3] - p[k]));
    const double share = whole > 0 ? std::clamp(dot(at.x - p[k], edge) / whole, 0.0, 1.0) : 0;
    at.x = q[(j + 1) % 3] + (q[j] - q[(j + 1) % 3]) * share;
    at.along = times(over(at.along, edge), back);
    at.triangle = other / 3;
    came = other;
  }
  return true;
}

void LineTracer::follow(At at, bool forward, SurfaceLine& line, const MayGoOn& may) const {
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
    const double step = step_in(at.triangle);
    At middle = at;
    if (walk(middle, 0.5 * step, nullptr)) {
      const Vec2d there = direction(middle, forward);
      if (there.x != 0 || there.y != 0) at.along = unit(times(at.along, over(there, middle.along)));
    }
    gone += step;
    const std::size_t before = line.points.size();
    const bool inside = walk(at, step, &line);
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
  const std::array<Vec2d, 3> p = corners(triangle);
  At at{triangle, p[0] * weights.x + p[1] * weights.y + p[2] * weights.z, {}};
  SurfaceLine line;
  line.points.push_back(in_space(triangle, at.x));
  line.triangles.push_back(triangle);
  follow(at, forward, line, may);
  return line;
}

Vec2d LineTracer::in_plane(std::uint32_t t, const Vec3d& p) const {
  const auto axes = field_.frame(t);
  const Vec3d d = p - field_.corner_point(3 * t);
  return {nacre::dot(d, axes[0]), nacre::dot(d, axes[1])};
}

Vec3d LineTracer::weights(std::uint32_t t, const Vec2d& x) const {
  const std::array<Vec2d, 3> p = corners(t);
  const double whole = cross(p[1], p[2]);
  if (whole == 0) return {1, 0, 0};
  const double b = std::clamp(cross(x, p[2]) / whole, 0.0, 1.0), c = std::clamp(cross(p[1], x) / whole, 0.0, 1.0 - b);
  return {1 - b - c, b, c};
}

LineTracer::Beside LineTracer::beside(std::uint32_t triangle, const Vec3d& from, double distance) const {
  At at{triangle, in_plane(triangle, from), {}};
  const Vec2d flow = direction(at, true);
  if (flow.x == 0 && flow.y == 0) return {};
  at.along = distance > 0 ? Vec2d{-flow.y, flow.x} : Vec2d{flow.y, -flow.x};
  if (!walk(at, std::fabs(distance), nullptr)) return {};
  return {at.triangle, weights(at.triangle, at.x), in_space(at.triangle, at.x)};
}

double LineTracer::speed(std::uint32_t triangle, const Vec3d& at) const {
  const Vec3d w = weights(triangle, in_plane(triangle, at));
  const std::array<Vec2d, 3> v = field_.corner_vectors(triangle);
  const Vec2d sum = v[0] * w.x + v[1] * w.y + v[2] * w.z;
  return std::hypot(sum.x, sum.y);
}

SurfaceLine LineTracer::leave(std::uint32_t saddle, const Vec3d& axis, bool forward) const {
  const CriticalPoint& point = points_[saddle];
  const std::array<Vec2d, 3> p = corners(point.triangle);
  const auto axes = field_.frame(point.triangle);
  At at{point.triangle, p[0] * point.weights.x + p[1] * point.weights.y + p[2] * point.weights.z,
        unit({nacre::dot(axis, axes[0]), nacre::dot(axis, axes[1])})};
  SurfaceLine line;
  line.from = saddle;
  line.forward = forward;
  line.points.push_back(in_space(at.triangle, at.x));
  line.triangles.push_back(at.triangle);
  if (!walk(at, 2 * step_in(at.triangle), &line)) {
    line.end = LineEnd::rim;
    return line;
  }
  follow(at, forward, line, {});
  return line;
}

std::vector<SurfaceLine> separatrices(const TangentField& field, std::span<const CriticalPoint> points) {
  Vec3d low(1e300), high(-1e300);
  for (std::size_t v = 0; v < field.vertices(); ++v) {
    low = min(low, field.vertex_point(v));
    high = max(high, field.vertex_point(v));
  }
  std::vector<SurfaceLine> lines;
  if (points.empty()) return lines;
  const LineTracer tracer(field, points, 4 * length(high - low));
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (points[i].kind != CriticalKind::saddle) continue;
    for (const bool forward : {true, false})
      for (const double side : {1.0, -1.0})
        lines.push_back(tracer.leave(i, (forward ? points[i].first_axis : points[i].second_axis) * side, forward));
  }
  return lines;
}

}  // namespace nacre
