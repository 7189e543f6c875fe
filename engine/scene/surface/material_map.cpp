// Nacre: vectors between two shapes of the same triangles, and how much one shape stretches the other.
#include "engine/scene/surface/material_map.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

constexpr double no_area = 1e-12;  // of a triangle, over the product of its squared edges

/// A triangle's edges from its first corner, and what they say about vectors.
struct Frame {
  Vec3d e, f, normal;
  double ee, ff, ef, determinant;

  Frame(std::span<const Vec3d> points, const Triangle& t)
      : e(points[t.b] - points[t.a]), f(points[t.c] - points[t.a]), ee(dot(e, e)), ff(dot(f, f)), ef(dot(e, f)) {
    const Vec3d n = cross(e, f);
    determinant = dot(n, n);
    normal = normalized(n);
  }
  bool flat() const { return !(determinant > no_area * ee * ff); }
};

/// Whether some direction is stretched or shortened by more than `limit`.
bool is_distorted(const Frame& from, const Frame& to, double limit) {
  if (to.flat()) return true;
  // In an orthonormal frame of the first: C = F^T F has the squared stretches as eigenvalues.
  const double l = std::sqrt(from.ee), x = from.ef / l, y = std::sqrt(from.determinant / from.ee);
  const double c11 = to.ee / from.ee, c12 = (to.ef - to.ee * x / l) / (l * y);
  const double c22 = (to.ff - 2 * to.ef * x / l + to.ee * x * x / from.ee) / (y * y);
  const double mean = 0.5 * (c11 + c22), off = std::hypot(0.5 * (c11 - c22), c12);
  return mean + off > limit * limit || mean - off < 1 / (limit * limit);
}

}  // namespace

void transfer_vectors(std::span<const Vec3d> from, std::span<const Vec3d> to, std::span<const Triangle> triangles,
                      std::span<const Vec3f> vectors, std::span<Vec3f> result) {
  std::vector<Vec3d> sum(vectors.size());
  std::vector<double> weight(vectors.size());
  for (const Triangle& t : triangles) {
    const Frame a(from, t), b(to, t);
    if (a.flat()) continue;
    const double area = std::sqrt(a.determinant);
    for (int k = 0; k < 3; ++k) {
      const Vec3d v(vectors[t[k]]);
      const double ve = dot(v, a.e), vf = dot(v, a.f);
      const double along_e = (ve * a.ff - vf * a.ef) / a.determinant, along_f = (vf * a.ee - ve * a.ef) / a.determinant;
      sum[t[k]] += (b.e * along_e + b.f * along_f + b.normal * dot(v, a.normal)) * area;
      weight[t[k]] += area;
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = weight[i] > 0 ? Vec3f(sum[i] / weight[i]) : Vec3f();
}

double distorted_share(std::span<const Vec3d> from, std::span<const Vec3d> to, std::span<const Triangle> triangles,
                       double limit) {
  double all = 0, distorted = 0;
  for (const Triangle& t : triangles) {
    const Frame a(from, t);
    if (a.flat()) continue;
    const double area = std::sqrt(a.determinant);
    all += area;
    if (is_distorted(a, Frame(to, t), limit)) distorted += area;
  }
  return all > 0 ? distorted / all : 0;
}

}  // namespace nacre
