// Nacre: the equivalence of gradients (Ruuth & Merriman 2008): plain 3-D stencils on extended values are the surface's
// own operators.
#pragma once

#include <cmath>

#include "compute/embedding/build_brick_octree.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"

namespace nacre::test {

/// A spherical harmonic of degree 3 and one of degree 2, mixed; `x` is a unit vector.
inline double harmonic_2(const Vec3d& x) { return x.x * x.y + 0.5 * (x.z * x.z - x.x * x.x); }
inline double harmonic_3(const Vec3d& x) { return x.z * (x.x * x.x - x.y * x.y); }
inline double harmonics(const Vec3d& x) { return harmonic_2(x) + harmonic_3(x); }

/// Laplace-Beltrami on the unit sphere: -l (l + 1) for each degree.
inline double laplacian_of_harmonics(const Vec3d& x) { return -6 * harmonic_2(x) - 12 * harmonic_3(x); }

inline Vec3d gradient_of_harmonics(const Vec3d& p) {
  const Vec3d full{p.y - p.x + 2 * p.z * p.x, p.x - 2 * p.z * p.y, p.z + p.x * p.x - p.y * p.y};
  return full - p * dot(full, p);
}

/// A sphere of `radius` cells around `centre`.
struct Ball {
  Vec3d centre;
  double radius;
  NACRE_HD Vec3d unit(const Vec3d& x) const { return normalized(x - centre); }
};

/// Extends `value`, given as a table over the cells' closest points: the polyhedron's closest points would be off by
/// its facets, so those of the sphere itself are taken.
struct ExtendHarmonics {
  Ball ball;
  double* values;
  NACRE_HD void operator()(CellIndex cell, const Int3& position, BrickOctreeView::Cursor&) const {
    const Vec3d x = ball.unit(Vec3d(position) + Vec3d(0.5));
    values[cell] = x.x * x.y + 0.5 * (x.z * x.z - x.x * x.x) + x.z * (x.x * x.x - x.y * x.y);
  }
};

/// Gradient and Laplacian by central differences in each cell that has all six neighbours.
struct PlainOperators {
  const double* values;
  double* out;  ///< 4 per cell: gradient, Laplacian; NaN where a neighbour is missing
  NACRE_HD void operator()(CellIndex cell, const Int3& position, BrickOctreeView::Cursor& cursor) const {
    double laplacian = 0;
    for (int axis = 0; axis < 3; ++axis) {
      Int3 low = position, high = position;
      low[axis] -= 1;
      high[axis] += 1;
      const CellIndex a = cursor.find(low), b = cursor.find(high);
      const bool there = a != no_cell && b != no_cell;
      out[4 * cell + axis] = there ? 0.5 * (values[b] - values[a]) : double(NAN);
      laplacian += there ? values[a] + values[b] - 2 * values[cell] : double(NAN);
    }
    out[4 * cell + 3] = laplacian;
  }
};

/// The operators' results interpolated linearly at a surface cell's own point of the sphere.
struct AtSurface {
  Ball ball;
  const double* operators;
  double* out;  ///< 7 per surface cell: gradient, Laplacian, the unit vector
  NACRE_HD void operator()(CellIndex s, CellIndex, const Int3& position, BrickOctreeView::Cursor& cursor) const {
    const Vec3d unit = ball.unit(Vec3d(position) + Vec3d(0.5));
    const LinearWeights weights(band_point(ball.centre + unit * ball.radius));
    CellIndex at[8];
    const unsigned there = cursor.eight(weights.first, at);
    for (int j = 0; j < 4; ++j) {
      double sum = there == 0xff ? 0 : double(NAN);
      for (int k = 0; k < 8 && there == 0xff; ++k) sum += double(weights[k]) * operators[4 * at[k] + j];
      out[7 * s + j] = sum;
    }
    for (int j = 0; j < 3; ++j) out[7 * s + 4 + j] = unit[j];
  }
};

/// Largest errors of gradient and Laplacian on a unit sphere that is `radius` cells wide.
struct OperatorErrors {
  double gradient = 0, laplacian = 0;
};

template <class Backend>
OperatorErrors operator_errors(Executor<Backend>& exec, double radius) {
  Arena& arena = exec.arena();
  const std::size_t mark = arena.mark();
  const int levels = radius > 24 ? 4 : radius > 12 ? 3 : 2;
  const Ball ball{Vec3d(4 << levels) + Vec3d(0.21, 0.37, 0.11), radius};
  const Mesh mesh = sphere(ball.centre, radius, 32);
  const BrickOctree octree =
      build_brick_octree(exec, upload(exec, mesh), std::uint32_t(mesh.triangles.size()), levels, 3.6);
  const BrickOctreeView view = octree.view();
  Array<double> values = arena.permanent<double>(view.cells);
  Array<double> operators = arena.permanent<double>(4 * view.cells);
  Array<double> out = arena.permanent<double>(7 * view.surface_cells);
  for_each_cell(exec, view, ExtendHarmonics{ball, values.data()});
  for_each_cell(exec, view, PlainOperators{values.data(), operators.data()});
  for_each_surface_cell(exec, view, AtSurface{ball, operators.data(), out.data()});
  OperatorErrors errors;
  const std::vector<double> found = out.download();
  for (CellIndex s = 0; s < view.surface_cells; ++s) {
    const double* f = found.data() + 7 * s;
    const Vec3d unit{f[4], f[5], f[6]}, gradient = Vec3d(f[0], f[1], f[2]) * radius;  // per cell to per radius
    const double g = length(gradient - gradient_of_harmonics(unit));
    const double l = std::fabs(f[3] * radius * radius - laplacian_of_harmonics(unit));
    errors.gradient = g <= errors.gradient ? errors.gradient : g;  // NaN stays
    errors.laplacian = l <= errors.laplacian ? errors.laplacian : l;
  }
  arena.rewind(mark);
  return errors;
}

template <class Backend>
void PlainStencilsAreSurfaceOperators(Executor<Backend>& exec) {
  const OperatorErrors coarse = operator_errors(exec, 10), middle = operator_errors(exec, 20),
                       fine = operator_errors(exec, 40);
  EXPECT_LT(fine.gradient, 0.02);
  EXPECT_LT(fine.laplacian, 0.1);
  for (const auto& [wide, narrow] : {std::pair(coarse, middle), std::pair(middle, fine)}) {
    EXPECT_GT(std::log2(wide.gradient / narrow.gradient), 1.7) << "second order";
    EXPECT_GT(std::log2(wide.laplacian / narrow.laplacian), 1.7) << "second order";
  }
}

NACRE_DEVICE_TEST(Extension, PlainStencilsAreSurfaceOperators)

}  // namespace nacre::test
