// Nacre: closed orbits of fields whose orbits are known.
#include "compute/topology/closed_orbits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

std::vector<ClosedOrbit> orbits_of(const Shape& shape, const std::function<Vec3d(const Vec3d&)>& field) {
  const std::vector<Vec3f> vectors = vectors_on(shape, field);
  const TangentField tangent(shape.points, shape.triangles, vectors);
  const std::vector<CriticalPoint> points = find_critical_points(tangent, 0).points;
  return closed_orbits(tangent, points, separatrices(tangent, points), separation_lines(tangent, 1));
}

/// Round the z axis in 2 pi units of time, and towards the equator at a rate: two foci and one orbit.
std::function<Vec3d(const Vec3d&)> to_the_equator(double rate) {
  return [rate](const Vec3d& p) {
    const Vec3d up = Vec3d(0, 0, 1) - p * p.z;
    return Vec3d(-p.y, p.x, 0) - up * (rate * p.z);
  };
}

TEST(ClosedOrbits, TheEquatorOfASphereAttracts) {
  const Shape sphere = divided_sphere(5);
  for (const double rate : {0.05, 0.2}) {
    const std::vector<ClosedOrbit> orbits = orbits_of(sphere, to_the_equator(rate));
    ASSERT_EQ(orbits.size(), 1u) << rate;
    EXPECT_TRUE(orbits[0].attracting);
    EXPECT_NEAR(orbits[0].multiplier, std::exp(-6.2832 * rate), 0.05);
    EXPECT_EQ(orbits[0].points.front(), orbits[0].points.back());
    double length_of = 0;
    for (std::size_t i = 0; i < orbits[0].points.size(); ++i) {
      ASSERT_NEAR(orbits[0].points[i].z, 0, 0.01);
      if (i > 0) length_of += length(orbits[0].points[i] - orbits[0].points[i - 1]);
    }
    EXPECT_NEAR(length_of, 6.2832, 0.02);
  }
}

TEST(ClosedOrbits, BackwardsItRepels) {
  const auto backwards = [field = to_the_equator(0.1)](const Vec3d& p) { return -field(p); };
  const std::vector<ClosedOrbit> orbits = orbits_of(divided_sphere(4), backwards);
  ASSERT_EQ(orbits.size(), 1u);
  EXPECT_FALSE(orbits[0].attracting);
}

/// Without any critical point: the orbits are found by their separation and attachment lines.
TEST(ClosedOrbits, OnATorusOneOfEachKind) {
  const auto field = [](const Vec3d& p) {
    const double r = std::hypot(p.x, p.y), cosine = (r - 1) / 0.4, sine = p.z / 0.4;
    return Vec3d(-p.y, p.x, 0) - Vec3d(-sine * p.x / r, -sine * p.y / r, cosine) * (0.15 * sine);
  };
  const std::vector<ClosedOrbit> orbits = orbits_of(torus(32), field);
  ASSERT_EQ(orbits.size(), 2u);
  for (const ClosedOrbit& orbit : orbits)
    for (const Vec3d& p : orbit.points) ASSERT_NEAR(std::hypot(p.x, p.y), orbit.attracting ? 1.4 : 0.6, 0.02);
  EXPECT_NE(orbits[0].attracting, orbits[1].attracting);
}

TEST(ClosedOrbits, NoneAroundACentreOrWhereAllLinesEnd) {
  EXPECT_TRUE(orbits_of(divided_sphere(4), [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); }).empty());
  EXPECT_TRUE(orbits_of(divided_sphere(4), [](const Vec3d& p) { return Vec3d(2 * p.x, 4 * p.y, 6 * p.z); }).empty());
  EXPECT_TRUE(orbits_of(torus(24), [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); }).empty());
}

}  // namespace
}  // namespace nacre::test
