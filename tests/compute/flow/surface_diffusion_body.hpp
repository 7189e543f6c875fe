// Nacre: test bodies for diffusion by the closest point method: eigenfunctions of a sphere, also along vectors,
// and the stability of a step.
#pragma once

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/flow/surface_diffusion.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/small_cases.hpp"

namespace nacre::test {

struct NoReaction {
  NACRE_HD Pair operator()(const Pair&) const { return {0, 0}; }
};

/// A function and its eigenvalue, on the unit sphere.
struct Eigenfunction {
  std::function<double(const Vec3d&)> value;
  double eigenvalue;
};

/// A sphere of triangles in a closest-point grid, with vectors of length 1 around its axis.
template <class Backend>
class DiffusingSphere {
 public:
  /// `radius` in cells. Triangles are refined along, with the square of that, to edges of 1.6 / radius cells: the
  /// normals of facets are off by their size, and closest points with them.
  DiffusingSphere(Executor<Backend>& exec, double radius, bool vectors)
      : exec_(exec), radius_(radius), mark_(exec.arena().mark()), centre_(radius + 8.21, radius + 8.37, radius + 8.11) {
    const Mesh mesh = sphere(centre_, radius, int(2 * radius * radius));
    std::vector<Vec3f> normals, around(mesh.points.size());
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) normals.push_back(Vec3f(unit(mesh.points[t[k]])));
    for (std::size_t i = 0; i < around.size() && vectors; ++i) {
      const Vec3d p = mesh.points[i] - centre_;
      around[i] = Vec3f(normalized(Vec3d(-p.y, p.x, 0)));
    }
    Arena& arena = exec.arena();
    mesh_ = {arena.permanent_copy<Vec3d>(mesh.points).data(), arena.permanent_copy<Triangle>(mesh.triangles).data(),
             arena.permanent_copy<Vec3f>(normals).data()};
    vectors_ = arena.permanent_copy<Vec3f>(around);
    grid_ = build_closest_point_grid(exec, mesh_, std::uint32_t(mesh.triangles.size()),
                                     Int3(int(2 * radius + 17) / 4 + 1), 4, float(diffusion_radius));
    band_ = find_diffusion_band(exec, grid_.view(), grid_.cells);
    diffusion_ = SurfaceDiffusion<Backend>(exec, grid_.view(), grid_.cells, band_);
    value_ = arena.permanent<Pair>(grid_.cells);
    change_ = arena.permanent<Pair>(grid_.cells);
    std::vector<Pair> nothing(grid_.cells, Pair{0, 0});
    value_.upload(nothing);
    change_.upload(nothing);
  }
  ~DiffusingSphere() { exec_.arena().rewind(mark_); }

  /// Twice as far along the vectors: I + 3 t t^T.
  void weigh() { diffusion_.weigh(exec_, mesh_, vectors_.data(), StretchBySpeed{2, 1e-3f}); }
  double stable_step() const { return 1 / diffusion_.largest_row(); }

  void set(const std::function<Pair(const Vec3d&)>& at) {
    std::vector<Pair> values(grid_.cells, Pair{0, 0});
    const Points points(*this);
    for (const std::uint32_t i : points.outer) values[i] = at(points.unit(i));
    value_.upload(values);
  }

  void go(int steps, double step, float most = 1e9f) {
    for (int k = 0; k < steps; ++k)
      diffusion_.step(exec_, Diffusivities{}, NoReaction{}, float(step), float(step), most, value_.data(),
                      change_.data());
  }

  /// Root mean square over the band of the differences from `exact`, of u and of v.
  struct Errors {
    double u = 0, v = 0;
  };
  Errors errors(const std::function<Pair(const Vec3d&)>& exact) const {
    const std::vector<Pair> values = value_.download();
    const Points points(*this);
    Errors sum;
    for (const std::uint32_t i : points.outer) {
      const Pair e = exact(points.unit(i));
      sum.u += std::pow(double(values[i].u) - double(e.u), 2);
      sum.v += std::pow(double(values[i].v) - double(e.v), 2);
    }
    return {std::sqrt(sum.u / double(points.outer.size())), std::sqrt(sum.v / double(points.outer.size()))};
  }

  double largest() const {
    double most = 0;
    for (const Pair& p : value_.download()) most = std::fabs(p.u) <= most ? most : std::fabs(double(p.u));
    return most;
  }

 private:
  /// The outer cells and the closest points of the grid, on the host.
  struct Points {
    std::vector<std::uint32_t> outer;
    std::vector<Float4> offset;
    std::vector<std::uint64_t> code;
    ClosestPointGridView view;
    Vec3d centre;

    explicit Points(const DiffusingSphere& sphere)
        : outer(sphere.band_.outer.download()),
          offset(sphere.grid_.offset.download()),
          code(sphere.grid_.brick_code.download()),
          view(sphere.grid_.view()),
          centre(sphere.centre_) {
      view.brick_code = code.data();
    }
    Vec3d unit(std::uint32_t i) const {
      const Float4 o = offset[i];
      return normalized(Vec3d(view.cell(i)) + Vec3d(0.5) + Vec3d(o.x, o.y, o.z) - centre);
    }
  };

  Vec3d unit(const Vec3d& p) const { return normalized(p - centre_); }

  Executor<Backend>& exec_;
  double radius_;
  std::size_t mark_;
  Vec3d centre_;
  MeshView mesh_{};
  Array<Vec3f> vectors_;
  ClosestPointGrid grid_;
  DiffusionBand band_;
  SurfaceDiffusion<Backend> diffusion_;
  Array<Pair> value_, change_;
};

/// Lets two eigenfunctions decay on spheres of 5, 10 and, but for small cases, 20 cells, and compares with the same
/// steps of the exact operator, so that only the error in space is left.
template <class Backend>
void expect_second_order(Executor<Backend>& exec, bool vectors, const Eigenfunction& first, const Eigenfunction& second,
                         double end, const char* what) {
  double before_u = 0, before_v = 0, first_u = 0, first_v = 0;
  const std::vector<double> radii = small_cases() ? std::vector{5.0, 10.0} : std::vector{5.0, 10.0, 20.0};
  for (const double radius : radii) {
    DiffusingSphere<Backend> sphere(exec, radius, vectors);
    sphere.weigh();
    const double duration = end * radius * radius;
    const int steps = int(std::ceil(duration / sphere.stable_step()));
    const auto at = [&](int count) {
      const auto left = [&](double eigenvalue) { return std::pow(1 - eigenvalue * end / steps, count); };
      return [&, u = left(first.eigenvalue), v = left(second.eigenvalue)](const Vec3d& x) {
        return Pair{float(first.value(x) * u), float(second.value(x) * v)};
      };
    };
    sphere.set(at(0));
    sphere.go(steps, duration / steps);
    const auto error = sphere.errors(at(steps));
    std::printf("%s, radius %2.0f cells, %d steps: errors %.3e %.3e", what, radius, steps, error.u, error.v);
    if (before_u > 0) {
      const double u = std::log2(before_u / error.u), v = std::log2(before_v / error.v);
      std::printf(", orders %.2f %.2f", u, v);
      EXPECT_GE(u, 1.6) << what << " at " << radius;
      EXPECT_GE(v, 1.6) << what << " at " << radius;
    } else {
      first_u = error.u;
      first_v = error.v;
    }
    std::printf("\n");
    before_u = error.u;
    before_v = error.v;
  }
  if (small_cases()) return;
  EXPECT_GE(0.5 * std::log2(first_u / before_u), 1.9) << what << ", over all three";
  EXPECT_GE(0.5 * std::log2(first_v / before_v), 1.9) << what << ", over all three";
  EXPECT_LT(before_u, 1e-3);
  EXPECT_LT(before_v, 1e-3);
}

/// Spherical harmonics of degree 2 and 3: eigenvalues l (l + 1).
template <class Backend>
void HarmonicsDecayInSecondOrder(Executor<Backend>& exec) {
  expect_second_order(exec, false, {[](const Vec3d& x) { return 2 * x.x * x.y; }, 6},
                      {[](const Vec3d& x) { return x.z * (x.x * x.x - x.y * x.y); }, 12}, 0.08, "isotropic");
}

/// sin^n(theta) cos(m phi).
inline double sectoral(const Vec3d& x, int n, int m) {
  return std::pow(std::hypot(x.x, x.y), n) * std::cos(m * std::atan2(x.y, x.x));
}

/// With diffusivity 4 around the axis and 1 along the meridians, sin^2m(theta) cos(m phi) decays at the rate
/// 2m (2m + 1): the separated equation is Legendre's with the order 2m in place of m.
template <class Backend>
void AlongVectorsToo(Executor<Backend>& exec) {
  expect_second_order(exec, true, {[](const Vec3d& x) { return sectoral(x, 4, 2); }, 20},
                      {[](const Vec3d& x) { return sectoral(x, 6, 3); }, 42}, 0.03, "along vectors");
}

/// At the limit noise only fades; at some multiple of it, it grows without bound.
template <class Backend>
void TheLimitIsStableAndMoreIsNot(Executor<Backend>& exec) {
  for (const bool vectors : {false, true}) {
    DiffusingSphere<Backend> sphere(exec, 8, vectors);
    sphere.weigh();
    // A row's weights are means of those of two cells, whose directions differ a little: the largest is nearly 12.
    EXPECT_NEAR(1 / sphere.stable_step(), vectors ? 12 : 6, 0.15);
    Random random(1);
    const auto noise = [&](const Vec3d&) { return Pair{float(random.between(-1, 1)), 0}; };
    sphere.set(noise);
    sphere.go(300, sphere.stable_step());
    EXPECT_LT(sphere.largest(), 1) << vectors;
    sphere.set(noise);
    sphere.go(300, 2.5 * sphere.stable_step());
    EXPECT_GT(sphere.largest(), 1e3) << vectors;
  }
}

NACRE_DEVICE_TEST(LongSurfaceDiffusion, HarmonicsDecayInSecondOrder)
NACRE_DEVICE_TEST(LongSurfaceDiffusion, AlongVectorsToo)
NACRE_DEVICE_TEST(SurfaceDiffusion, TheLimitIsStableAndMoreIsNot)

}  // namespace nacre::test
