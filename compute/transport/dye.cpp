// Nacre: dye that is carried along a surface, in mass.
#include "compute/transport/dye.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compute/device/error.hpp"
#include "compute/topology/tangent_field.hpp"

namespace nacre {
namespace {

template <class F>
void each(std::size_t n, const F& f) {
  tbb::parallel_for(std::size_t(0), n, f);
}

/// Superbee, of the slope upstream over the slope to the other cell.
double limited(double r) { return std::max({0.0, std::min(1.0, 2 * r), std::min(2.0, r)}); }

}  // namespace

Dye::Dye(std::size_t points, std::span<const Triangle> triangles, double diffusion)
    : triangles_(triangles.begin(), triangles.end()), diffusion_(diffusion), mass_(points) {
  struct Side {
    std::uint32_t low, high, corner;
  };
  std::vector<Side> sides;
  for (std::uint32_t c = 0; c < 3 * triangles_.size(); ++c) {
    const std::uint32_t p = corner_point(c), q = corner_point(TangentField::next(c));
    sides.push_back({std::min(p, q), std::max(p, q), c});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return s.low != t.low ? s.low < t.low : s.high != t.high ? s.high < t.high : s.corner < t.corner;
  });
  edge_of_.resize(sides.size());
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i; j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high; ++j)
      edge_of_[sides[j].corner] =
          std::uint32_t(2 * edges_.size() + (corner_point(sides[j].corner) == sides[i].low ? 0 : 1));
    if (j - i == 1) rims_.push_back({sides[i].corner, {}, {}});
    edges_.push_back({sides[i].low, sides[i].high});
  }
  const auto fill = [&](Lists& lists, std::size_t n, const auto& point_of) {
    lists.start.assign(points + 1, 0);
    lists.item.resize(n);
    for (std::size_t i = 0; i < n; ++i) ++lists.start[point_of(i) + 1];
    for (std::size_t p = 0; p < points; ++p) lists.start[p + 1] += lists.start[p];
    std::vector<std::uint32_t> next(lists.start.begin(), lists.start.end() - 1);
    for (std::size_t i = 0; i < n; ++i) lists.item[next[point_of(i)]++] = std::uint32_t(i);
  };
  fill(corners_of_, 3 * triangles_.size(), [&](std::size_t c) { return corner_point(c); });
  fill(edges_of_, 2 * edges_.size(), [&](std::size_t e) { return e % 2 == 0 ? edges_[e / 2].a : edges_[e / 2].b; });
  area_.resize(points);
  c_.resize(points);
  low_.resize(points);
  high_.resize(points);
  gradient_.resize(points);
  slope_.resize(triangles_.size());
  normal_.resize(triangles_.size());
  weight_.resize(edges_.size());
  flux_.resize(edges_.size());
}

/// Areas and weights of a shape.
void Dye::measure(std::span<const Vec3d> shape) {
  each(triangles_.size(), [&](std::size_t t) {
    const Triangle& tri = triangles_[t];
    normal_[t] = cross(shape[tri.b] - shape[tri.a], shape[tri.c] - shape[tri.a]);
  });
  each(area_.size(), [&](std::size_t p) {
    area_[p] = 0;
    for (const std::uint32_t c : corners_of_.of(p)) area_[p] += length(normal_[c / 3]) / 6;
  });
  std::fill(weight_.begin(), weight_.end(), 0);
  for (std::uint32_t c = 0; c < edge_of_.size(); ++c) {
    const double twice = length(normal_[c / 3]);
    if (!(twice > 0)) continue;
    const Vec3d &p = shape[corner_point(c)], &q = shape[corner_point(TangentField::next(c))],
                &r = shape[corner_point(TangentField::previous(c))];
    weight_[edge_of_[c] / 2] += 0.5 * dot(p - r, q - r) / twice;
  }
}

/// Through the border of two cells within a triangle, from the middle of their edge to the centroid, flows the vector
/// at its middle: five twelfths of both ends' and two of the third point's.
void Dye::find_fluxes(std::span<const Vec3d> shape, std::span<const Vec3f> vectors, bool last) {
  std::vector<Vec3d> unit(area_.size()), tangential(area_.size());
  each(unit.size(), [&](std::size_t p) {
    Vec3d sum;
    for (const std::uint32_t c : corners_of_.of(p)) sum += normal_[c / 3];
    unit[p] = normalized(sum);
    Vec3d v(vectors[p]);
    if (!is_finite(v)) v = {};
    tangential[p] = v - unit[p] * dot(v, unit[p]);
  });
  const auto in_plane = [&](std::uint32_t corner, const Vec3d& normal) {
    const std::uint32_t p = corner_point(corner);
    return turned(tangential[p], unit[p], normal);
  };
  std::vector<double>& flux = last ? last_flux_ : first_flux_;
  flux.assign(edges_.size(), 0);
  std::vector<double> of_side(edge_of_.size());
  each(triangles_.size(), [&](std::size_t t) {
    const Vec3d normal = normalized(normal_[t]);
    Vec3d v[3], x[3];
    for (std::uint32_t k = 0; k < 3; ++k) {
      x[k] = shape[triangles_[t][int(k)]];
      v[k] = in_plane(std::uint32_t(3 * t) + k, normal);
    }
    const Vec3d centroid = (x[0] + x[1] + x[2]) / 3.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      const Vec3d across = cross(centroid - (x[k] + x[l]) * 0.5, normal);  // from k to l
      of_side[3 * t + k] = dot((v[k] + v[l]) * (5.0 / 12) + v[m] * (1.0 / 6), across);
    }
  });
  for (std::size_t c = 0; c < of_side.size(); ++c)
    flux[edge_of_[c] / 2] += edge_of_[c] % 2 == 0 ? of_side[c] : -of_side[c];
  for (RimSide& side : rims_) {
    const std::uint32_t other = TangentField::next(side.corner);
    const Vec3d normal = normalized(normal_[side.corner / 3]);
    const Vec3d out = cross(shape[corner_point(other)] - shape[corner_point(side.corner)], normal) * 0.5;
    const double a = dot(in_plane(side.corner, normal), out), b = dot(in_plane(other, normal), out);
    double* to = last ? side.last : side.first;
    to[0] = std::max(0.0, 0.75 * a + 0.25 * b);
    to[1] = std::max(0.0, 0.25 * a + 0.75 * b);
  }
}

void Dye::release(std::span<const Vec3d> shape, std::span<const std::uint32_t> points) {
  measure(shape);
  for (const std::uint32_t p : points) {
    const double more = std::max(0.0, area_[p] - mass_[p]);
    mass_[p] += more;
    released_ += more;
  }
}

int Dye::sub_steps(double duration) const {
  std::vector<double> rate(area_.size());
  each(rate.size(), [&](std::size_t p) {
    double out = 0;
    for (const std::uint32_t e : edges_of_.of(p)) {
      const double sign = e % 2 == 0 ? 1 : -1;
      out +=
          std::max({0.0, sign * first_flux_[e / 2], sign * last_flux_[e / 2]}) + diffusion_ * std::fabs(weight_[e / 2]);
    }
    rate[p] = out;
  });
  for (const RimSide& side : rims_) {
    rate[corner_point(side.corner)] += std::max(side.first[0], side.last[0]);
    rate[corner_point(TangentField::next(side.corner))] += std::max(side.first[1], side.last[1]);
  }
  double most = 0;
  for (std::size_t p = 0; p < rate.size(); ++p)
    if (area_[p] > 0) most = std::max(most, 2 * rate[p] / area_[p]);
  const double wanted = std::ceil(most * duration);
  if (!(wanted <= most_sub_steps))
    throw Error("the dye needs more than " + std::to_string(most_sub_steps) + " sub-steps in a step",
                "the smallest triangles are too small for the vectors and the diffusion",
                "use a smaller `dye_diffusion`, or more `steps`");
  return std::max(1, int(wanted));
}

/// On the border of two cells, from the one upstream.
double Dye::face_value(std::span<const Vec3d> shape, std::uint32_t from, std::uint32_t to) const {
  const double ahead = c_[to] - c_[from];
  if (ahead == 0) return c_[from];
  const double before = std::clamp(c_[to] - 2 * dot(gradient_[from], shape[to] - shape[from]), low_[from], high_[from]);
  return c_[from] + 0.5 * limited((c_[from] - before) / ahead) * ahead;
}

/// One step of Euler's method. Returns what leaves over rims.
double Dye::euler(std::span<const Vec3d> shape, std::vector<double>& mass, double share, double duration) {
  each(c_.size(), [&](std::size_t p) { c_[p] = area_[p] > 0 ? mass[p] / area_[p] : 0; });
  each(triangles_.size(), [&](std::size_t t) {  // gradient x twice the area, as long as the triangle counts
    const Triangle& tri = triangles_[t];
    const Vec3d turning = (shape[tri.c] - shape[tri.b]) * c_[tri.a] + (shape[tri.a] - shape[tri.c]) * c_[tri.b] +
                          (shape[tri.b] - shape[tri.a]) * c_[tri.c];
    slope_[t] = cross(normalized(normal_[t]), turning);
  });
  each(c_.size(), [&](std::size_t p) {
    Vec3d sum;
    low_[p] = high_[p] = c_[p];
    for (const std::uint32_t c : corners_of_.of(p)) sum += slope_[c / 3];
    for (const std::uint32_t e : edges_of_.of(p)) {
      const double other = c_[e % 2 == 0 ? edges_[e / 2].b : edges_[e / 2].a];
      low_[p] = std::min(low_[p], other);
      high_[p] = std::max(high_[p], other);
    }
    gradient_[p] = area_[p] > 0 ? sum / (6 * area_[p]) : Vec3d();
  });
  each(edges_.size(), [&](std::size_t e) {
    const double f = first_flux_[e] + (last_flux_[e] - first_flux_[e]) * share;
    const auto [a, b] = edges_[e];
    flux_[e] = duration * (f * (f > 0 ? face_value(shape, a, b) : face_value(shape, b, a)) +
                           diffusion_ * weight_[e] * (c_[a] - c_[b]));
  });
  each(mass.size(), [&](std::size_t p) {
    double sum = 0;
    for (const std::uint32_t e : edges_of_.of(p)) sum += e % 2 == 0 ? flux_[e / 2] : -flux_[e / 2];
    mass[p] -= sum;
  });
  double left = 0;
  for (const RimSide& side : rims_)
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t p = corner_point(k == 0 ? side.corner : TangentField::next(side.corner));
      const double out = duration * c_[p] * (side.first[k] + (side.last[k] - side.first[k]) * share);
      mass[p] -= out;
      left += out;
    }
  return left;
}

int Dye::step(std::span<const Vec3d> shape, double duration, std::span<const Vec3f> first, std::span<const Vec3f> last,
              const std::atomic<bool>* stop) {
  measure(shape);
  find_fluxes(shape, first, false);
  find_fluxes(shape, last, true);
  const int n = sub_steps(duration);
  for (int k = 0; k < n; ++k) {
    if (stop && *stop) throw Interrupted();
    std::vector<double> next = mass_;
    double out = euler(shape, next, double(k) / n, duration / n);
    out += euler(shape, next, double(k + 1) / n, duration / n);
    each(mass_.size(), [&](std::size_t p) { mass_[p] = 0.5 * (mass_[p] + next[p]); });
    left_ += 0.5 * out;
  }
  return n;
}

std::vector<float> Dye::concentration(std::span<const Vec3d> shape) const {
  std::vector<float> result(mass_.size());
  each(result.size(), [&](std::size_t p) {
    double area = 0;
    for (const std::uint32_t c : corners_of_.of(p)) {
      const Triangle& t = triangles_[c / 3];
      area += length(cross(shape[t.b] - shape[t.a], shape[t.c] - shape[t.a])) / 6;
    }
    result[p] = area > 0 ? float(mass_[p] / area) : 0.0f;
  });
  return result;
}

double Dye::mass() const {
  double sum = 0;
  for (const double each_one : mass_) sum += each_one;
  return sum;
}

}  // namespace nacre
