// Nacre: lines along fields on spheres, tori and squares whose lines are known.
#include "compute/topology/surface_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

/// The critical points and separatrices of a field.
struct Skeleton {
  TangentField field;
  FlowTopology topology;
  std::vector<SurfaceLine> lines;
  Skeleton(const Shape& shape, const std::vector<Vec3f>& vectors, double persistence = 0.1)
      : field(shape.points, shape.triangles, vectors),
        topology(find_critical_points(field, persistence)),
        lines(separatrices(field, topology.points)) {}
};

TEST(SurfaceLines, SeparatricesOfAGradientAreGreatCircles) {
  const Shape sphere = divided_sphere(5);
  const Skeleton s(sphere, vectors_on(sphere, [](const Vec3d& p) {
                     return on_sphere({2 * p.x, 4 * p.y, 6 * p.z}, p);
                   }));
  ASSERT_EQ(s.lines.size(), 8u);
  std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
  for (const SurfaceLine& line : s.lines) {
    ASSERT_EQ(line.end, LineEnd::critical_point);
    EXPECT_EQ(s.topology.points[line.to].kind, line.forward ? CriticalKind::sink : CriticalKind::source);
    joined.insert({line.from, line.to});
    double length_of_it = 0;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      // With the flow in the plane x = 0, against it in z = 0.
      EXPECT_LT(std::fabs(line.forward ? line.points[i].x : line.points[i].z), 0.01);
      EXPECT_NEAR(length(line.points[i]), 1, 0.002);
      if (i > 0) length_of_it += length(line.points[i] - line.points[i - 1]);
    }
    EXPECT_NEAR(length_of_it, 1.5708, 0.01);
  }
  EXPECT_EQ(joined.size(), 8u);
}

TEST(SurfaceLines, ACircleClosesAfterARound) {
  const Shape sphere = divided_sphere(5);
  const std::vector<Vec3f> vectors = vectors_on(sphere, [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); });
  const TangentField field(sphere.points, sphere.triangles, vectors);
  const LineTracer tracer(field, {}, 100);
  const SurfaceLine line = tracer.trace(100, Vec3d(0.3, 0.3, 0.4), true);
  EXPECT_EQ(line.end, LineEnd::circling);
  for (const Vec3d& p : line.points) EXPECT_NEAR(p.z, line.points[0].z, 0.01);
  const SurfaceLine short_one = LineTracer(field, {}, 0.5).trace(100, Vec3d(0.3, 0.3, 0.4), false);
  EXPECT_LT(short_one.points.size(), line.points.size() / 10);
}

TEST(SurfaceLines, AreStraightOverEdgesAndEndAtRims) {
  const Shape plate = square(15);
  const TangentField field(plate.points, plate.triangles,
                           vectors_on(plate, [](const Vec3d&) { return Vec3d(1, 0.37, 0); }));
  const LineTracer tracer(field, {}, 100);
  for (const bool forward : {true, false}) {
    const SurfaceLine line = tracer.trace(210, Vec3d(0.2, 0.5, 0.3), forward);
    EXPECT_EQ(line.end, LineEnd::rim);
    const Vec3d first = line.points.front(), last = line.points.back();
    EXPECT_NEAR((last.y - first.y) / (last.x - first.x), 0.37, 1e-6);
    EXPECT_NEAR(std::max(std::fabs(last.x + 0.013), std::fabs(last.y + 0.007)), 0.5, 1e-9);
  }
}

TEST(SurfaceLines, EndWhereTheFieldIsZero) {
  const Shape plate = square(8);
  const TangentField still(plate.points, plate.triangles, std::vector<Vec3f>(plate.points.size()));
  const SurfaceLine line = LineTracer(still, {}, 100).trace(5, Vec3d(0.2, 0.5, 0.3), true);
  EXPECT_EQ(line.end, LineEnd::still);
  EXPECT_EQ(line.points.size(), 1u);
}

TEST(SurfaceLines, UnderNoiseTheSaddlesStillReachSourcesAndSinks) {
  const Shape sphere = divided_sphere(5);
  const Skeleton s(sphere,
                   vectors_on(
                       sphere,
                       [](const Vec3d& p) {
                         return on_sphere({2 * p.x, 4 * p.y, 6 * p.z}, p);
                       },
                       0.01),
                   0.12);
  ASSERT_EQ(s.lines.size(), 8u);
  for (const SurfaceLine& line : s.lines) {
    ASSERT_EQ(line.end, LineEnd::critical_point);
    EXPECT_EQ(s.topology.points[line.to].kind, line.forward ? CriticalKind::sink : CriticalKind::source);
    for (const Vec3d& p : line.points) EXPECT_LT(std::fabs(line.forward ? p.x : p.z), 0.12);
  }
}

}  // namespace
}  // namespace nacre::test
