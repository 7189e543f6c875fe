// Nacre: a tangential vector field on triangles, with the rotation of the vectors from point to point.
#include "compute/topology/tangent_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nacre {
namespace {

constexpr double pi = std::numbers::pi;

/// The same angle in -pi..pi.
double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

/// The same angle in 0..2 pi.
double positive(double angle) {
  const double a = std::fmod(angle, 2 * pi);
  return a < 0 ? a + 2 * pi : a;
}

/// Two unit vectors across a unit normal.
std::array<Vec3d, 2> across(const Vec3d& normal) {
  const Vec3d other = std::fabs(normal.x) < 0.7 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d u = normalized(cross(other, normal));
  return {u, cross(normal, u)};
}

}  // namespace

Vec3d turned(const Vec3d& v, const Vec3d& from, const Vec3d& to) {
  const Vec3d axis = cross(from, to);
  const double c = dot(from, to);
  if (c < -0.999999) return v - 2.0 * dot(v, from) * from;  // no shortest way
  return v * c + cross(axis, v) + axis * (dot(axis, v) / (1 + c));
}

TangentField::TangentField(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                           std::span<const Vec3f> vectors)
    : points_(points), triangles_(triangles) {
  find_twins();
  find_vertices(vectors);
  rotate();
  walk_rims();
}

void TangentField::find_twins() {
  struct Edge {
    std::uint32_t low, high, half;
    bool up;  // from the lower point to the higher
  };
  std::vector<Edge> edges;
  edges.reserve(3 * triangles_.size());
  for (std::uint32_t h = 0; h < 3 * triangles_.size(); ++h) {
    const std::uint32_t a = triangles_[h / 3][int(h % 3)], b = triangles_[h / 3][int(next(h) % 3)];
    edges.push_back({std::min(a, b), std::max(a, b), h, a < b});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& s, const Edge& t) {
    return s.low != t.low ? s.low < t.low : s.high != t.high ? s.high < t.high : s.half < t.half;
  });
  twin_.assign(edges.size(), none);
  for (std::size_t i = 0, j; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high;) ++j;
    if (j - i != 2 || edges[i].up == edges[i + 1].up) continue;
    twin_[edges[i].half] = edges[i + 1].half;
    twin_[edges[i + 1].half] = edges[i].half;
  }
}

void TangentField::find_vertices(std::span<const Vec3f> vectors) {
  const std::size_t corners = 3 * triangles_.size();
  vertex_.assign(corners, none);
  direction_.resize(corners);
  inner_.resize(corners);
  for (std::uint32_t c = 0; c < corners; ++c) {
    if (vertex_[c] != none) continue;
    std::uint32_t first = c;
    while (twin_[first] != none && next(twin_[first]) != c) first = next(twin_[first]);  // clockwise
    if (twin_[first] != none) first = c;
    const auto v = std::uint32_t(point_.size());
    point_.push_back(triangles_[c / 3][int(c % 3)]);
    first_.push_back(first);
    for (std::uint32_t at = first; at != none && vertex_[at] == none; at = twin_[previous(at)]) vertex_[at] = v;
    measure_fan(first, v);
  }
  double largest = 0;
  for (std::size_t v = 0; v < point_.size(); ++v) {
    Vec3d value(vectors[point_[v]]);
    if (!is_finite(value)) value = {};
    value -= normal_[v] * dot(value, normal_[v]);
    value_.push_back(value);
    largest = std::max(largest, length(value));
  }
  for (std::size_t v = 0; v < point_.size(); ++v) {
    if (!(length(value_[v]) > 1e-7 * largest)) value_[v] = {};
    angle_.push_back(polar_angle(first_[v], std::uint32_t(v)));
  }
}

void TangentField::measure_fan(std::uint32_t first, std::uint32_t v) {
  double sum = 0;
  Vec3d normal;
  bool rim = false;
  std::uint32_t at = first;
  do {
    const Vec3d p = corner_point(at), a = corner_point(next(at)) - p, b = corner_point(previous(at)) - p;
    inner_[at] = std::max(std::atan2(length(cross(a, b)), dot(a, b)), 1e-9);
    direction_[at] = sum;
    sum += inner_[at];
    normal += normalized(cross(a, b)) * inner_[at];
    at = twin_[previous(at)];
    rim = at == none;
  } while (!rim && at != first);
  normal_.push_back(normalized(normal));
  const double scale = (rim ? pi : 2 * pi) / sum;
  at = first;
  do {
    inner_[at] *= scale;
    direction_[at] *= scale;
    at = twin_[previous(at)];
  } while (at != none && at != first);
  (void)v;
}

double TangentField::polar_angle(std::uint32_t first, std::uint32_t v) const {
  const auto [x, y] = across(normal_[v]);
  const auto planar = [x = x, y = y](const Vec3d& d) { return std::atan2(dot(d, y), dot(d, x)); };
  const double wanted = planar(value_[v]);
  double nearest = 1e300, result = 0;
  const auto try_sector = [&](double from, double to, double begin, double width) {  // true: it is in there
    const double offset = positive(wanted - from), span = positive(to - from);
    if (offset <= span && span > 0) {
      result = begin + width * offset / span;
      return true;
    }
    if (std::fabs(wrapped(wanted - from)) < nearest) nearest = std::fabs(wrapped(wanted - from)), result = begin;
    return false;
  };
  std::uint32_t at = first;
  double begin_angle = planar(corner_point(next(first)) - corner_point(first));
  const double first_angle = begin_angle;
  do {
    const double end_angle = planar(corner_point(previous(at)) - corner_point(at));
    if (positive(end_angle - begin_angle) <= pi && try_sector(begin_angle, end_angle, direction_[at], inner_[at]))
      return result;
    begin_angle = end_angle;
    at = twin_[previous(at)];
  } while (at != none && at != first);
  if (at == none) try_sector(begin_angle, first_angle, pi, pi);
  return result;
}

void TangentField::rotate() {
  const std::size_t corners = vertex_.size();
  rotation_.resize(corners);
  std::size_t edges = 0;
  for (std::uint32_t h = 0; h < corners; ++h) {
    const std::uint32_t other = twin_[h];
    if (other != none && other < h) {
      rotation_[h] = -rotation_[other];
      continue;
    }
    ++edges;
    const double back = other == none ? pi : direction_[other];
    rotation_[h] = wrapped(angle_[vertex_[next(h)]] - angle_[vertex_[h]] - (back + pi - direction_[h]));
  }
  euler_ = int(std::int64_t(vertices()) - std::int64_t(edges) + std::int64_t(triangles_.size()));
  index_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    double sum = -pi;
    for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) sum += rotation_[h] + inner_[h];
    index_[t] = int(std::lround(sum / (2 * pi)));
  }
}

void TangentField::walk_rims() {
  std::vector<bool> seen(vertex_.size());
  for (std::uint32_t h = 0; h < vertex_.size(); ++h) {
    if (twin_[h] != none || seen[h]) continue;
    double sum = 0;
    for (std::uint32_t at = h; !seen[at]; at = first_[vertex_[next(at)]]) {
      seen[at] = true;
      sum += rotation_[at];
    }
    rims_.push_back({h, int(std::lround(1 - sum / (2 * pi)))});
  }
}

double TangentField::least_speed(std::uint32_t h) const {
  const double a = speed(vertex_[h]), b = speed(vertex_[next(h)]);
  if (a == 0 || b == 0) return 0;
  const double x = b * std::cos(rotation_[h]) - a, y = b * std::sin(rotation_[h]), squared = x * x + y * y;
  const double s = squared > 0 ? std::clamp(-a * x / squared, 0.0, 1.0) : 0;
  return std::hypot(a + s * x, s * y);
}

std::array<Vec3d, 3> TangentField::frame(std::size_t t) const {
  const auto h = std::uint32_t(3 * t);
  const Vec3d a = corner_point(h + 1) - corner_point(h), b = corner_point(h + 2) - corner_point(h);
  const Vec3d normal = normalized(cross(a, b)), x = normalized(a);
  return {x, cross(normal, x), normal};
}

double TangentField::diagonal() const {
  Vec3d low(1e300), high(-1e300);
  for (std::size_t v = 0; v < vertices(); ++v) {
    low = min(low, vertex_point(v));
    high = max(high, vertex_point(v));
  }
  return vertices() == 0 ? 0 : length(high - low);
}

std::array<Vec2d, 3> TangentField::corner_vectors(std::size_t t) const {
  const auto h = std::uint32_t(3 * t);
  const std::array<Vec3d, 3> axes = frame(t);
  const double share = (inner_[h] + inner_[h + 1] + inner_[h + 2] - pi) / 3;
  const double at[3] = {0, rotation_[h] + share, rotation_[h] + rotation_[h + 1] + 2 * share};
  double x = 0, y = 0;  // how far these angles are turned from those of the vectors, in the mean
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vec3d flat = turned(value_[vertex_[h + k]], normal_[vertex_[h + k]], axes[2]);
    const double u = dot(flat, axes[0]), v = dot(flat, axes[1]), c = std::cos(at[k]), s = std::sin(at[k]);
    x += u * c + v * s;
    y += v * c - u * s;
  }
  const double offset = std::atan2(y, x);
  std::array<Vec2d, 3> result;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const double n = speed(vertex_[h + k]);
    result[k] = {n * std::cos(at[k] + offset), n * std::sin(at[k] + offset)};
  }
  return result;
}

}  // namespace nacre
