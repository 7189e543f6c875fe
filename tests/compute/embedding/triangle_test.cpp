// Nacre: geometry of one triangle.
#include "compute/embedding/triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/compute/meshes.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test {
namespace {

const Corners unit{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_LE(length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " "
                                      << b.z;
}

TEST(ClosestPoint, FallsInEachOfTheSevenRegions) {
  expect_near(closest_point(unit, {0.25, 0.25, 2}), {0.25, 0.25, 0}, 1e-15);
  expect_near(closest_point(unit, {-1, -2, 3}), {0, 0, 0}, 1e-15);
  expect_near(closest_point(unit, {3, -0.5, 1}), {1, 0, 0}, 1e-15);
  expect_near(closest_point(unit, {-0.5, 3, 1}), {0, 1, 0}, 1e-15);
  expect_near(closest_point(unit, {0.3, -2, 1}), {0.3, 0, 0}, 1e-15);
  expect_near(closest_point(unit, {-2, 0.3, -1}), {0, 0.3, 0}, 1e-15);
  expect_near(closest_point(unit, {1.5, 1.7, 0}), {0.4, 0.6, 0}, 1e-15);
}

TEST(ClosestPoint, NoSampleOfTheTriangleIsCloser) {
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const Corners t{random.point(-2, 2), random.point(-2, 2), random.point(-2, 2)};
    const Vec3d p = random.point(-4, 4), q = closest_point(t, p);
    EXPECT_NEAR(length(reference_closest_point(t, q) - q), 0, 1e-12);
    double nearest = 1e300;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        nearest = std::min(nearest, length(t.a + (t.b - t.a) * (i / 60.0) + (t.c - t.a) * (j / 60.0) - p));
    EXPECT_LE(length(q - p), nearest + 1e-12);
    EXPECT_GE(length(q - p), nearest - 0.15);
  }
}

/// Largest distance between closest_point and the reference, over needles and caps `thin` times thinner than long.
double worst_on_slivers(double thin, double size) {
  Random random(2);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3d along = normalized(random.point(-1, 1)), across = normalized(cross(along, random.point(-1, 1)));
    const double middle = k % 2 ? random() : 1.0;  // a cap or a needle
    const Vec3d origin = random.point(0, 100);
    const Vec3d corner[3] = {origin, origin + along * size, origin + (along * middle + across * thin) * size};
    const Corners t{corner[k % 3], corner[(k + 1) % 3], corner[(k + 2) % 3]};
    const Vec3d p = origin + along * (size * random()) + random.point(-5, 5);
    const Vec3d q = closest_point(t, p), r = reference_closest_point(t, p);
    worst = std::max(worst, std::isfinite(q.x + q.y + q.z) ? length(q - r) : 1e300);
  }
  return worst;
}

TEST(ClosestPoint, HoldsOnSlivers) {
  for (const double size : {0.01, 1.0, 50.0})
    for (const double thin : {1e-3, 1e-5, 1e-7, 1e-8, 1e-10, 1e-12, 1e-14, 0.0})
      EXPECT_LE(worst_on_slivers(thin, size), 1e-6) << thin << " thin, " << size << " long";
}

TEST(ClosestPoint, WithoutAreaItIsAnEdgeOrAPoint) {
  expect_near(closest_point({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {4, 5, 6}), {1, 1, 1}, 0);
  expect_near(closest_point({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {1.7, 3, 0}), {1.7, 0, 0}, 1e-15);
  expect_near(closest_point({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {1.7, 3, 0}), {1.7, 0, 0}, 1e-15);
  expect_near(closest_point({{1, 0, 0}, {0, 0, 0}, {2, 0, 0}}, {1.7, 0, -3}), {1.7, 0, 0}, 1e-15);
  expect_near(closest_point({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}}, {1.7, 0, -3}), {1.7, 0, 0}, 1e-15);
  expect_near(closest_point({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}}, {9, 0, -3}), {2, 0, 0}, 1e-15);
}

TEST(Barycentric, SumsToOneAndReproducesPoints) {
  Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const Corners t{random.point(-2, 2), random.point(-2, 2), random.point(-2, 2)};
    double v = random(), w = random();
    if (v + w > 1) v = 1 - v, w = 1 - w;
    const Vec3d p = t.a * (1 - v - w) + t.b * v + t.c * w, b = barycentric(t, p);
    EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-12);
    expect_near(t.a * b.x + t.b * b.y + t.c * b.z, p, 1e-9);
  }
  expect_near(barycentric(unit, {0, 1, 0}), {0, 0, 1}, 0);
}

TEST(Barycentric, StaysInsideTheTriangle) {
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    Corners t{random.point(-2, 2), random.point(-2, 2), random.point(-2, 2)};
    if (k % 4 == 0) t.c = t.a + (t.b - t.a) * random.between(-2, 2);
    if (k % 8 == 1) t.b = t.a;
    if (k % 16 == 2) t.b = t.c = t.a;
    const Vec3d b = barycentric(t, random.point(-4, 4));
    EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-12);
    EXPECT_GE(std::min({b.x, b.y, b.z}), 0);
  }
}

TEST(Barycentric, ReproducesPointsOfSlivers) {
  Random random(5);
  for (const double thin : {1e-4, 1e-8, 1e-12, 0.0})
    for (int k = 0; k < 2000; ++k) {
      const Vec3d along = normalized(random.point(-1, 1)), across = normalized(cross(along, random.point(-1, 1)));
      const Vec3d corner[3] = {Vec3d(3, 4, 5), Vec3d(3, 4, 5) + along * 2.0,
                               Vec3d(3, 4, 5) + along * (2 * random()) + across * thin};
      const Corners t{corner[k % 3], corner[(k + 1) % 3], corner[(k + 2) % 3]};
      const Vec3d p = closest_point(t, corner[0] + along * (2 * random())), b = barycentric(t, p);
      EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-9);
      expect_near(t.a * b.x + t.b * b.y + t.c * b.z, p, 1e-6);
    }
}

TEST(Barycentric, InFloatItIsAsStated) {
  Random random(6);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3d far(3000, 4000, 1000);  // cells; a triangle from a thousandth of one up
    const double size = std::pow(10.0, random.between(-3, 2));
    Corners t{far + random.point(-1, 1) * size, far + random.point(-1, 1) * size, far + random.point(-1, 1) * size};
    if (k % 4 == 0) t.c = t.a + (t.b - t.a) * random.between(-2, 2) + random.point(-1, 1) * (0.2 * size);
    double v = random(), w = random();
    if (v + w > 1) v = 1 - v, w = 1 - w;
    if (k % 3 == 0) w = 0;
    const Vec3d p = t.a * (1 - v - w) + t.b * v + t.c * w;
    const Vec3f single = barycentric_in_float(t, p);
    worst = std::max(worst, length(Vec3d(single) - barycentric(t, p)));
    EXPECT_GE(std::min({single.x, single.y, single.z}), 0);
  }
  EXPECT_LE(worst, 1e-5);
  EXPECT_GT(worst, 0) << "not the same function";
}

TEST(TouchesCube, KnownCases) {
  const Vec3d centre(0.5);
  EXPECT_TRUE(touches_cube({{0.2, 0.2, 0.2}, {0.3, 0.2, 0.2}, {0.2, 0.3, 0.2}}, centre, 0.5));  // inside
  EXPECT_TRUE(touches_cube({{1, 1, 1}, {2, 1, 1}, {1, 2, 3}}, centre, 0.5));                    // at a corner
  EXPECT_TRUE(touches_cube({{-9, -9, 1}, {9, -9, 1}, {0, 20, 1}}, centre, 0.5));                // on a face's plane
  EXPECT_FALSE(touches_cube({{-9, -9, 1.001}, {9, -9, 1.001}, {0, 20, 1.001}}, centre, 0.5));
  EXPECT_TRUE(touches_cube({{-90, 0, -90}, {90, 1, -90}, {0, 0.5, 200}}, centre, 0.5));      // right through
  EXPECT_FALSE(touches_cube({{2.1, 0, 0.5}, {0, 2.1, 0.5}, {2.1, 2.1, 0.5}}, centre, 0.5));  // past an edge
  EXPECT_TRUE(touches_cube({{1.9, 0, 0.5}, {0, 1.9, 0.5}, {2.1, 2.1, 0.5}}, centre, 0.5));
  EXPECT_FALSE(touches_cube({{3.1, 0, 0}, {0, 3.1, 0}, {0, 0, 3.1}}, centre, 0.5));  // past a corner
  EXPECT_TRUE(touches_cube({{2.9, 0, 0}, {0, 2.9, 0}, {0, 0, 2.9}}, centre, 0.5));
  EXPECT_FALSE(touches_cube({{50, 50, 50}, {51, 50, 50}, {50, 51, 50}}, centre, 0.5));          // far
  EXPECT_TRUE(touches_cube({{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}, centre, 0.5));  // a point
  EXPECT_TRUE(touches_cube({{-5, -5, -5}, {5, 5, 5}, {5, 5, 5}}, centre, 0.5));                 // a needle
  EXPECT_FALSE(touches_cube({{-5, -5, 1.1}, {5, 5, 1.1}, {5, 5, 1.1}}, centre, 0.5));
}

/// The triangle clipped against the cube's six planes.
bool clipped_touches(const Corners& t, const Vec3d& centre, double half) {
  std::vector<Vec3d> polygon{t.a - centre, t.b - centre, t.c - centre};
  for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
    const int axis = plane / 2;
    const double sign = plane % 2 ? 1 : -1;
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double dp = half - sign * p[axis], dq = half - sign * q[axis];
      if (dp >= 0) kept.push_back(p);
      if ((dp < 0) != (dq < 0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    polygon = kept;
  }
  return !polygon.empty();
}

TEST(TouchesCube, AgreesWithClipping) {
  Random random(6);
  int touching = 0;
  for (int k = 0; k < 30000; ++k) {
    const double size = k % 3 ? 1.5 : 60;
    const Vec3d centre = random.point(-1, 1);
    const Vec3d p = random.point(-1.5, 1.5);
    const Corners t{p, p + random.point(-size, size), p + random.point(-size, size)};
    const bool touches = touches_cube(t, centre, 0.5);
    touching += touches;
    if (touches)
      EXPECT_TRUE(clipped_touches(t, centre, 0.5 + 1e-9)) << k;
    else
      EXPECT_FALSE(clipped_touches(t, centre, 0.5 - 1e-9)) << k;
  }
  EXPECT_GT(touching, 5000);
  EXPECT_LT(touching, 25000);
}

TEST(TouchesCube, NeedlesAreFoundAlongTheirWholeLength) {
  Random random(7);
  for (int k = 0; k < 5000; ++k) {
    const Vec3d a = random.point(0, 50), b = random.point(0, 50);
    const Corners t{a, b, a + (b - a) * random()};  // without area but for rounding
    const Vec3d p = a + (b - a) * random();
    const Vec3d centre{std::floor(p.x) + 0.5, std::floor(p.y) + 0.5, std::floor(p.z) + 0.5};
    EXPECT_TRUE(touches_cube(t, centre, 0.5 + 1e-7)) << k;
  }
}

}  // namespace
}  // namespace nacre::test
