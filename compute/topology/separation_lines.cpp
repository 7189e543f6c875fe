// Nacre: where the flow leaves a surface, or comes onto it, along lines.
#include "compute/topology/separation_lines.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

constexpr std::size_t reach = 6;         // edges, before and behind, that give the direction of a curve
constexpr double least_cosine = 0.8660;  // of its angle with the flow: 30 degrees

using Matrix = std::array<Vec3d, 3>;  // rows

Vec3d apply(const Matrix& m, const Vec3d& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

/// The mean gradient of the vectors at each vertex, from those of its triangles. Vectors are turned into a triangle's
/// plane with the normals, so that a curved surface alone gives none.
std::vector<Matrix> vertex_gradients(const TangentField& field) {
  std::vector<Matrix> sum(field.vertices());
  std::vector<double> area(field.vertices(), 0);
  for (std::uint32_t t = 0; t < field.triangles(); ++t) {
    const Vec3d normal = field.frame(t)[2];
    const Vec3d p[3] = {field.corner_point(3 * t), field.corner_point(3 * t + 1), field.corner_point(3 * t + 2)};
    const double twice = length(cross(p[1] - p[0], p[2] - p[0]));
    if (!(twice > 0)) continue;
    Matrix gradient{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = field.vertex(3 * t + k);
      const Vec3d value = turned(field.value(v), field.normal(v), normal);
      const Vec3d slope = cross(normal, p[(k + 2) % 3] - p[(k + 1) % 3]) / twice;  // of the hat function
      for (int row = 0; row < 3; ++row) gradient[std::size_t(row)] += slope * value[row];
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = field.vertex(3 * t + k);
      for (int row = 0; row < 3; ++row) sum[v][std::size_t(row)] += gradient[std::size_t(row)] * twice;
      area[v] += twice;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    for (Vec3d& row : sum[v]) row = area[v] > 0 ? row / area[v] : Vec3d{};
  return sum;
}

/// Each the mean of those around it: data of simulations are rough from triangle to triangle.
std::vector<Matrix> smoothed(const TangentField& field, const std::vector<Matrix>& gradients) {
  std::vector<Matrix> sum(gradients.size());
  std::vector<double> count(gradients.size(), 0);
  for (std::uint32_t c = 0; c < 3 * field.triangles(); ++c) {
    const std::uint32_t v = field.vertex(c);
    for (const std::uint32_t corner : {c, TangentField::next(c), TangentField::previous(c)}) {
      const Matrix& other = gradients[field.vertex(corner)];
      for (std::size_t row = 0; row < 3; ++row) sum[v][row] += other[row];
    }
    count[v] += 3;
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    for (Vec3d& row : sum[v]) row = count[v] > 0 ? row / count[v] : Vec3d{};
  return sum;
}

/// What is known at a vertex, linear between them.
struct Rates {
  double turning = 0;  ///< det(u, J u), whose zeros are the lines
  double along = 0;    ///< u . J u and across . J across, times |u|^2: of the eigenvalues, where these are lines
  double across = 0;
  double squared = 0;  ///< |u|^2
};

Rates rates_at(const TangentField& field, std::size_t v, const Matrix& gradient) {
  const Vec3d u = field.value(v), n = field.normal(v), side = cross(n, u), change = apply(gradient, u);
  return {dot(side, change), dot(u, change), dot(side, apply(gradient, side)), dot(u, u)};
}

struct Crossing {
  std::uint32_t triangle;
  Vec3d point;
  Rates rates;
  Vec3d velocity;
};

class Finder {
 public:
  Finder(const TangentField& field, double least_strength) : field_(field), least_(least_strength) {
    const std::vector<Matrix> gradients = smoothed(field, vertex_gradients(field));
    for (std::size_t v = 0; v < field.vertices(); ++v) rates_.push_back(rates_at(field, v, gradients[v]));
    done_.assign(3 * field.triangles(), 0);
  }

  std::vector<SeparationLine> operator()() {
    std::vector<SeparationLine> lines;
    for (std::uint32_t h = 0; h < 3 * field_.triangles(); ++h)
      if (!done_[h] && crossed(h))
        for (SeparationLine& line : parts_of(curve_through(h))) lines.push_back(std::move(line));
    return lines;
  }

 private:
  std::size_t start_of(std::uint32_t h) const { return field_.vertex(h); }
  std::size_t end_of(std::uint32_t h) const { return field_.vertex(TangentField::next(h)); }
  /// Zero counts as above it: a line crosses two edges of a triangle, or none.
  bool crossed(std::uint32_t h) const { return (rates_[start_of(h)].turning < 0) != (rates_[end_of(h)].turning < 0); }

  Crossing crossing(std::uint32_t h) const {
    const std::size_t a = start_of(h), b = end_of(h);
    const Rates &ra = rates_[a], &rb = rates_[b];
    const double s = std::clamp(ra.turning / (ra.turning - rb.turning), 0.0, 1.0);
    const auto between = [s](double x, double y) { return x + s * (y - x); };
    const Vec3d p = field_.corner_point(h), q = field_.corner_point(TangentField::next(h));
    return {h / 3,
            p + (q - p) * s,
            {0, between(ra.along, rb.along), between(ra.across, rb.across), between(ra.squared, rb.squared)},
            field_.value(a) + (field_.value(b) - field_.value(a)) * s};
  }

  /// Marks an edge, from both of its triangles.
  void mark(std::uint32_t h) {
    done_[h] = 1;
    if (field_.twin(h) != none) done_[field_.twin(h)] = 1;
  }

  /// Follows the zeros through the triangle of `h` and on, to a rim or round to `h`: then it is true.
  bool follow(std::uint32_t h, std::vector<Crossing>& points) {
    while (true) {
      const std::uint32_t one = TangentField::next(h), other = TangentField::previous(h);
      const std::uint32_t out = crossed(one) ? one : other;
      points.push_back(crossing(out));
      if (done_[out]) return true;
      mark(out);
      if (field_.twin(out) == none) return false;
      h = field_.twin(out);
    }
  }

  std::vector<Crossing> curve_through(std::uint32_t h) {
    mark(h);
    std::vector<Crossing> ahead, behind;
    const bool closed = follow(h, ahead);
    if (closed) ahead.back() = crossing(h);  // the same to the byte
    if (!closed && field_.twin(h) != none) follow(field_.twin(h), behind);
    std::reverse(behind.begin(), behind.end());
    behind.push_back(crossing(h));
    behind.insert(behind.end(), ahead.begin(), ahead.end());
    return behind;
  }

  /// 1: separation; -1: attachment; 0: neither, or the curve there does not go the way of the flow, which it does where
  /// streamlines come together for good.
  static int kind_of(const std::vector<Crossing>& curve, std::size_t i) {
    const Rates& r = curve[i].rates;
    if (!(r.squared > 0)) return 0;
    const Vec3d way = curve[std::min(i + reach, curve.size() - 1)].point - curve[i < reach ? 0 : i - reach].point;
    if (std::fabs(dot(way, curve[i].velocity)) < least_cosine * length(way) * length(curve[i].velocity)) return 0;
    return r.across < std::min(r.along, 0.0) ? 1 : r.across > std::max(r.along, 0.0) ? -1 : 0;
  }

  /// The pieces of a curve that are of one kind and strong enough.
  std::vector<SeparationLine> parts_of(const std::vector<Crossing>& curve) const {
    std::vector<SeparationLine> parts;
    for (std::size_t i = 0; i < curve.size();) {
      const int kind = kind_of(curve, i);
      std::size_t end = i + 1;
      while (end < curve.size() && kind_of(curve, end) == kind) ++end;
      SeparationLine line;
      line.separation = kind > 0;
      for (std::size_t k = i; k < end; ++k) {
        line.points.push_back(curve[k].point);
        line.triangles.push_back(curve[k].triangle);
        if (k == i) continue;
        const Rates &a = curve[k - 1].rates, &b = curve[k].rates;
        // Seconds along the piece, times the rate across: only what the flow itself follows counts.
        const Vec3d piece = curve[k].point - curve[k - 1].point, u = (curve[k].velocity + curve[k - 1].velocity) * 0.5;
        const double rate = 0.5 * (a.across / a.squared + b.across / b.squared);
        line.strength += std::fabs(rate * dot(piece, u)) / std::max(dot(u, u), 1e-300);
      }
      if (kind != 0 && line.points.size() > 1 && line.strength >= least_) parts.push_back(std::move(line));
      i = end;
    }
    return parts;
  }

  const TangentField& field_;
  double least_;
  std::vector<Rates> rates_;
  std::vector<char> done_;
};

}  // namespace

std::vector<SeparationLine> separation_lines(const TangentField& field, double least_strength) {
  return Finder(field, least_strength)();
}

}  // namespace nacre
