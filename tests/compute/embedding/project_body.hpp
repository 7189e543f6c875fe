// Nacre: test bodies for the WENO4 projection onto a surface (the table of its order).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/compute/embedding/host_grid.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test {

struct ProjectPoint {
  ClosestPointGridView grid;
  const Vec3f* points;
  Float4* result;  // w: 1 where there is one
  NACRE_HD void operator()(std::int64_t i) const {
    Vec3f p{};
    const bool found = project(grid, points[i], p);
    result[i] = {p.x, p.y, p.z, found ? 1.0f : 0.0f};
  }
};

template <class Backend>
std::vector<Float4> project_all(Executor<Backend>& exec, const ClosestPointGrid& grid,
                                const std::vector<Vec3f>& points) {
  Arena::Scope scope(exec.arena());
  Array<Vec3f> in = exec.arena().template temporary<Vec3f>(points.size());
  in.upload(points);
  Array<Float4> out = exec.arena().template temporary<Float4>(points.size());
  exec.for_each(std::int64_t(points.size()), ProjectPoint{grid.view(), in.data(), out.data()});
  return out.download();
}

/// A surface whose closest points are known exactly; `size` scales it.
struct AnalyticSphere {
  Vec3d centre;
  double size;
  Mesh mesh(int n) const { return sphere(centre, size, n); }
  Vec3d closest(const Vec3d& x) const { return centre + normalized(x - centre) * size; }
};

struct AnalyticTorus {
  Vec3d centre;
  double size;  // of the ring; the tube has half of it
  Mesh mesh(int n) const { return torus(centre, size, size / 2, n); }
  Vec3d closest(const Vec3d& x) const {
    const Vec3d d = x - centre, ring = normalized(Vec3d(d.x, d.y, 0)) * size;
    return centre + ring + normalized(d - ring) * (size / 2);
  }
};

/// Points up to a cell off the surface, not nearer to its rim than the stencil.
template <class Shape>
std::vector<Vec3f> points_near(const Shape& shape, int count) {
  Random random(51);
  std::vector<Vec3f> points;
  while (int(points.size()) < count) {
    const Vec3d x = shape.centre + random.point(-1.6, 1.6) * shape.size;
    const Vec3d p = shape.closest(x);
    points.push_back(Vec3f(p + normalized(x - p) * random()));
  }
  return points;
}

struct ProjectionError {
  double mean = 0, max = 0;  ///< in units of `size`
};

/// Error of projection where the grid holds the exact closest points of `shape`.
template <class Backend, class Shape>
ProjectionError projection_error(Executor<Backend>& exec, const Shape& shape, int cells) {
  const std::size_t mark = exec.arena().mark();
  ClosestPointGrid grid = embed(exec, shape.mesh(int(shape.size) * 4), cells);
  HostGrid host(grid);
  for (std::uint32_t at = 0; at < host.offset.size(); ++at) {
    const Vec3d x = host.centre(at), o = shape.closest(x) - x;
    host.offset[at] = {float(o.x), float(o.y), float(o.z), float(length(o))};
  }
  grid.offset.upload(host.offset);
  const std::vector<Vec3f> points = points_near(shape, 20000);
  const std::vector<Float4> projected = project_all(exec, grid, points);
  ProjectionError error;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(projected[i].w, 1.0f);
    const Vec3d p(projected[i].x, projected[i].y, projected[i].z);
    const double e = length(p - shape.closest(Vec3d(points[i]))) / shape.size;
    error.mean += e / double(points.size());
    error.max = std::max(error.max, e);
  }
  exec.arena().rewind(mark);
  return error;
}

template <class Shape, class Backend>
void expect_third_order(Executor<Backend>& exec, const char* name, double coarsest, double extent) {
  ProjectionError last;
  for (int level = 0; level < 3; ++level) {
    const double size = coarsest * (1 << level);
    const int cells = int(2 * (extent * size + 7));
    const ProjectionError e = projection_error(exec, Shape{Vec3d(cells / 2 + 0.13), size}, cells);
    std::printf("%-7s %6.1f cells: mean %.2e max %.2e", name, size, e.mean, e.max);
    if (level > 0) {
      const double mean = std::log2(last.mean / e.mean), max = std::log2(last.max / e.max);
      std::printf("   order %.2f (mean) %.2f (max)", mean, max);
      EXPECT_GE(mean, 3.0) << name << ", " << size;
      EXPECT_GE(max, 3.0) << name << ", " << size;
    }
    std::printf("\n");
    last = e;
  }
}

template <class Backend>
void OrderThreeOnASphere(Executor<Backend>& exec) {
  expect_third_order<AnalyticSphere>(exec, "sphere", 6, 1);
}

template <class Backend>
void OrderThreeOnATorus(Executor<Backend>& exec) {
  expect_third_order<AnalyticTorus>(exec, "torus", 9, 1.5);
}

/// From facets: off the true sphere by no more than the facets are, and off the facets by no more than that either.
template <class Backend>
void FacetsBoundTheError(Executor<Backend>& exec) {
  for (const int n : {12, 24, 48}) {
    const AnalyticSphere shape{Vec3d(20.13), 12};
    const Mesh mesh = shape.mesh(n);
    const std::size_t mark = exec.arena().mark();
    const ClosestPointGrid grid = embed(exec, mesh, 40);
    double sagitta = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Corners c = mesh.corners(t);
        const Vec3d p = k == 0 ? (c.a + c.b + c.c) / 3.0 : k == 1 ? (c.b + c.c) / 2.0 : (c.a + c.b) / 2.0;
        sagitta = std::max(sagitta, shape.size - length(p - shape.centre));
      }
    const std::vector<Vec3f> points = points_near(shape, 4000);
    const std::vector<Float4> projected = project_all(exec, grid, points);
    const BruteForce brute(mesh.points, mesh.triangles);
    double off_sphere = 0, off_facets = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d p(projected[i].x, projected[i].y, projected[i].z);
      off_sphere = std::max(off_sphere, std::fabs(length(p - shape.centre) - shape.size));
      if (i % 10 == 0) off_facets = std::max(off_facets, brute(p).distance);
    }
    std::printf(
        "sphere of %5zu facets: sagitta %.4f, projected points off the sphere by %.4f, off the facets by %.4f\n",
        mesh.triangles.size(), sagitta, off_sphere, off_facets);
    EXPECT_LE(off_sphere, 1.1 * sagitta);
    EXPECT_LE(off_facets, 1.1 * sagitta);
    exec.arena().rewind(mark);
  }
}

template <class Backend>
void APlaneIsExact(Executor<Backend>& exec) {
  const Mesh mesh = sheet({6.2, 6.1, 9.3}, {30, 3, 2}, {-2, 30, 4}, 1);
  const ClosestPointGrid grid = embed(exec, mesh, 44);
  Random random(52);
  std::vector<Vec3f> points;
  for (int i = 0; i < 2000; ++i)
    points.push_back(Vec3f(mesh.points[0] + (mesh.points[1] - mesh.points[0]) * random.between(0.25, 0.75) +
                           (mesh.points[2] - mesh.points[0]) * random.between(0.25, 0.75) + random.point(-1, 1)));
  const std::vector<Float4> projected = project_all(exec, grid, points);
  const Corners plane = mesh.corners(0);
  const Vec3d n = normalized(cross(plane.b - plane.a, plane.c - plane.a));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d x(points[i]), p(projected[i].x, projected[i].y, projected[i].z);
    EXPECT_LE(length(p - (x - n * dot(n, x - plane.a))), 2e-5);
  }
}

template <class Backend>
void OutsideOfTheBandThereIsNone(Executor<Backend>& exec) {
  const ClosestPointGrid grid = embed(exec, sheet({8, 8, 9.3}, {8, 0, 0}, {0, 8, 0}, 1), 40);
  const std::vector<Float4> projected =
      project_all(exec, grid, {{12, 12, 10}, {12, 12, 30}, {-3, 12, 9}, {12, 12, 1e6f}, {12.2f, 12.3f, 0.2f}});
  EXPECT_EQ(projected[0].w, 1.0f);
  EXPECT_NEAR(projected[0].z, 9.3f, 1e-5);
  for (int k = 1; k <= 3; ++k) EXPECT_EQ(projected[k].w, 0.0f) << k;
}

NACRE_DEVICE_TEST(Project, OrderThreeOnASphere)
NACRE_DEVICE_TEST(Project, OrderThreeOnATorus)
NACRE_DEVICE_TEST(Project, FacetsBoundTheError)
NACRE_DEVICE_TEST(Project, APlaneIsExact)
NACRE_DEVICE_TEST(Project, OutsideOfTheBandThereIsNone)

}  // namespace nacre::test
