// Nacre: test bodies for particles that move within their rings of triangles.
#pragma once

#include <cmath>
#include <vector>

#include "compute/device/random.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/particles/ring_smoothing.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/particles/analytic_projector.hpp"

namespace nacre::test {

/// Particles with their rings, on the device.
template <class Backend>
struct RingRun {
  Executor<Backend>& exec;
  Array<Float4> position, slid, direction;
  Array<float> margin;
  Array<std::uint32_t> first, interface;
  Array<RingEdge> edge;
  Array<std::uint8_t> order;

  /// All of interface 0, which is of `junction_order`.
  RingRun(Executor<Backend>& e, const std::vector<Vec3f>& points, const Vec3f& normal_or_tangent, int junction_order,
          const TriangleRings& rings)
      : exec(e) {
    Arena& arena = exec.arena();
    std::vector<Float4> positions;
    for (const Vec3f& p : points) positions.push_back({p.x, p.y, p.z, 1});
    const Vec3f d = normal_or_tangent;
    position = arena.template permanent_copy<Float4>(positions);
    slid = arena.template permanent_copy<Float4>(positions);
    margin = arena.template permanent_copy<float>(std::vector<float>(points.size(), 0));
    direction = arena.template permanent_copy<Float4>(std::vector<Float4>(points.size(), Float4{d.x, d.y, d.z, 7}));
    first = arena.template permanent_copy<std::uint32_t>(rings.first);
    edge = arena.template permanent_copy<RingEdge>(rings.edge);
    interface = arena.template permanent_copy<std::uint32_t>(std::vector<std::uint32_t>(points.size(), 0));
    order = arena.template permanent_copy<std::uint8_t>(std::vector<std::uint8_t>{std::uint8_t(junction_order)});
  }

  detail::RingStep step_from(const Array<Float4>& from, std::uint32_t shake) const {
    return {first.data(), edge.data(), order.data(), interface.data(), from.data(), direction.data(), shake};
  }

  /// One step, not back onto the interface.
  std::vector<Vec3f> slide(std::uint32_t shake) {
    exec.for_each(std::int64_t(position.size()), detail::SlideInRing{step_from(position, shake), slid.data()});
    return points_of(slid);
  }

  /// An even number of steps.
  template <class Projector>
  std::vector<Vec3f> turns(const Projector& projector, int count) {
    for (int k = 0; k < count; k += 2) {
      slide(0);
      exec.for_each(std::int64_t(position.size()),
                    detail::SettleInRing<Projector>{step_from(slid, 0), projector, position.data(), direction.data(),
                                                    margin.data()});
    }
    return points_of(position);
  }

  static std::vector<Vec3f> points_of(const Array<Float4>& positions) {
    std::vector<Vec3f> points;
    for (const Float4& p : positions.download()) points.push_back({p.x, p.y, p.z});
    return points;
  }
};

/// An even number of rows of a lattice of equilateral triangles with sides 1, as a mesh.
inline SurfaceMesh lattice_mesh(int columns, int rows) {
  SurfaceMesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) mesh.points.push_back({20 + i + 0.5 * (j % 2), 20 + j * std::sqrt(0.75), 0});
  const auto at = [&](int i, int j) { return std::uint32_t(j * columns + i); };
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i)
      if (j % 2 == 0) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      } else {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  mesh.materials.assign(mesh.triangles.size(), {0, 1});
  return mesh;
}

inline std::vector<std::uint32_t> all_points(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) numbers.push_back(v);
  return numbers;
}

/// The inner points of a disturbed lattice come back to where all triangles are equilateral; its rim has no rings and
/// stays.
template <class Backend>
void ADisturbedLatticeBecomesEven(Executor<Backend>& exec) {
  constexpr int columns = 12, rows = 10;
  const SurfaceMesh even = lattice_mesh(columns, rows);
  std::vector<std::uint8_t> inner(even.points.size(), 0);
  std::vector<Vec3f> points;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::size_t v = std::size_t(j * columns + i);
      inner[v] = i > 0 && i + 1 < columns && j > 0 && j + 1 < rows;
      const auto shift = [&](std::uint32_t axis) {
        return inner[v] ? 0.5f * uniform_random(3, v, axis) - 0.25f : 0.0f;
      };
      points.push_back(Vec3f(even.points[v]) + Vec3f(shift(0), shift(1), 0));
    }
  const TriangleRings rings = triangle_rings(even, all_points(even), inner, points.size());
  RingRun<Backend> run(exec, points, {0, 0, 1}, 2, rings);
  const AnalyticProjector<Plane> projector{{1}};
  const auto worst = [&](const std::vector<Vec3f>& now) {
    SurfaceMesh mesh = even;
    for (std::size_t v = 0; v < now.size(); ++v) mesh.points[v] = Vec3d(now[v]);
    return surface_quality(mesh).all.radius_ratio_min;
  };
  EXPECT_LT(worst(points), 0.75);
  const std::vector<Vec3f> few = run.turns(projector, SmoothingRule().turns);
  EXPECT_GT(worst(few), 0.9);
  const std::vector<Vec3f> many = run.turns(projector, 60);
  for (std::size_t v = 0; v < many.size(); ++v) {
    EXPECT_LT(length(Vec3d(many[v]) - even.points[v]), 0.01) << v;
    EXPECT_TRUE(inner[v] || few[v] == points[v]) << v;
  }
}

/// A shaken step goes anywhere in the plane, by no more than 0.3 heights along each axis; another seed gives another
/// position. The steps that follow lead back.
template <class Backend>
void AShakenLatticeSettlesAgain(Executor<Backend>& exec) {
  const SurfaceMesh even = lattice_mesh(12, 10);
  std::vector<std::uint8_t> inner(even.points.size(), 0);
  std::vector<Vec3f> points;
  for (std::size_t v = 0; v < even.points.size(); ++v) {
    inner[v] = v % 12 > 0 && v % 12 < 11 && v >= 12 && v < 108;
    points.push_back(Vec3f(even.points[v]));
  }
  const TriangleRings rings = triangle_rings(even, all_points(even), inner, points.size());
  const AnalyticProjector<Plane> projector{{1}};
  const auto shaken = [&](std::uint32_t seed) {
    return RingRun<Backend>(exec, points, {0, 0, 1}, 2, rings).slide(seed);
  };
  const std::vector<Vec3f> once = shaken(3), other = shaken(5);
  const float most = 0.3f * std::sqrt(0.75f) + 1e-5f;
  double far = 0;
  int differ = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Vec3f d = once[v] - points[v];
    EXPECT_TRUE(inner[v] || d == Vec3f()) << v;
    EXPECT_TRUE(std::fabs(d.x) <= most && std::fabs(d.y) <= most && d.z == 0) << v;
    far += double(length(d));
    differ += !(once[v] == other[v]);
  }
  EXPECT_GT(far / 80, 0.1);  // of 80 inner points; 0.2 by the square's mean
  EXPECT_EQ(differ, 80);
  RingRun<Backend> run(exec, once, {0, 0, 1}, 2, rings);
  const std::vector<Vec3f> settled = run.turns(projector, 60);
  for (std::size_t v = 0; v < settled.size(); ++v) EXPECT_LT(length(settled[v] - points[v]), 0.01f) << v;
}

/// The line y = 20, z = 0.
struct Line {
  NACRE_HD bool project(std::uint32_t, const Vec3f& p, float, EmbeddedPoint& on, float) const {
    on = {{p.x, 20, 0}, {1, 0, 0}, 1, 4};
    return true;
  }
};

/// On a curve they move along it alone; at a point not at all. What a particle carries beside its position stays.
template <class Backend>
void CurvesAreKeptAndPointsStay(Executor<Backend>& exec) {
  TriangleRings rings;  // of particle 0: two triangles on the side of y > 0, apexes of which lie at x = 0.5 and 1.5
  rings.first = {0, 2, 2, 2, 2};
  rings.edge = {{1, 2}, {2, 3}};
  const std::vector<Vec3f> points = {{20.2f, 20, 0}, {20, 21, 0}, {21, 21, 0}, {22, 21, 0}};
  const Line projector;
  RingRun<Backend> curve(exec, points, {1, 0, 0}, 1, rings);
  const std::vector<Vec3f> slid = curve.turns(projector, 60);
  EXPECT_NEAR(slid[0].x, 21, 0.01) << "between the two";
  EXPECT_NEAR(slid[0].y, 20, 1e-5);
  EXPECT_EQ(curve.direction.download()[0].w, 7);
  RingRun<Backend> point(exec, points, {0, 0, 0}, 0, rings);
  EXPECT_TRUE(point.turns(projector, 4)[0] == points[0]);
}

/// Nobody leaves the interface: beyond the rim there is none. In many steps neither, if the margin is remembered.
template <class Backend>
void NobodyIsSmoothedOverTheRim(Executor<Backend>& exec) {
  TriangleRings rings;
  rings.first = {0, 1, 1, 1};
  rings.edge = {{1, 2}};
  const std::vector<Vec3f> points = {{9.9f, 0, 0}, {9.4f, -1, 0}, {9.4f, 1, 0}};  // its best position is at 11.13
  const Vec3f up(0, 0, 1);
  const AnalyticProjector<Plane> rim{{1}, 10};
  EXPECT_GT(RingRun<Backend>(exec, points, up, 2, rings).turns(AnalyticProjector<Plane>{{1}}, 2)[0].x, 10);
  EXPECT_TRUE(RingRun<Backend>(exec, points, up, 2, rings).turns(rim, 2)[0] == points[0]);
  std::vector<Vec3f> far = points;
  for (Vec3f& p : far) p.x -= 1.2f;  // the best position is at 9.93 now
  const float near_rim = RingRun<Backend>(exec, far, up, 2, rings).turns(rim, 60)[0].x;
  EXPECT_NEAR(near_rim, 9.932, 0.005);
  for (Vec3f& p : far) p.x += 0.4f;  // and at 10.33
  EXPECT_LE(RingRun<Backend>(exec, far, up, 2, rings).turns(rim, 60)[0].x, 10);
}

NACRE_DEVICE_TEST(RingSmoothing, ADisturbedLatticeBecomesEven)
NACRE_DEVICE_TEST(RingSmoothing, AShakenLatticeSettlesAgain)
NACRE_DEVICE_TEST(RingSmoothing, CurvesAreKeptAndPointsStay)
NACRE_DEVICE_TEST(RingSmoothing, NobodyIsSmoothedOverTheRim)

}  // namespace nacre::test
