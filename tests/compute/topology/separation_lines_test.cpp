// Nacre: lines of separation and attachment on fields whose lines are known.
#include "compute/topology/separation_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

std::vector<SeparationLine> lines_of(const Shape& shape, const std::function<Vec3d(const Vec3d&)>& field,
                                     double least = 1, double noise = 0) {
  const std::vector<Vec3f> vectors = vectors_on(shape, field, noise);
  return separation_lines(TangentField(shape.points, shape.triangles, vectors), least);
}

/// Round the axis once in 2 pi units of time, and from the inner equator of the torus to the outer one.
Vec3d to_the_outer_equator(const Vec3d& p) {
  const double r = std::hypot(p.x, p.y), cosine = (r - 1) / 0.4, sine = p.z / 0.4;
  const Vec3d round(-p.y, p.x, 0), up(-sine * p.x / r, -sine * p.y / r, cosine);
  return round - up * (0.3 * sine);
}

// exp(-0.3 / 0.4 t), for 2 pi units of time
constexpr double once_round = 2 * 3.14159265 * 0.3 / 0.4;

TEST(SeparationLines, EquatorsOfATorusAreOneOfEachKind) {
  const std::vector<SeparationLine> lines = lines_of(torus(48), to_the_outer_equator, 2);
  ASSERT_EQ(lines.size(), 2u);
  for (const SeparationLine& line : lines) {
    EXPECT_EQ(line.points.front(), line.points.back()) << "closed";
    for (const Vec3d& p : line.points) {
      ASSERT_NEAR(std::hypot(p.x, p.y), line.separation ? 1.4 : 0.6, 0.01);
      ASSERT_NEAR(p.z, 0, 0.01);
    }
    EXPECT_NEAR(line.strength, once_round, 0.15);
  }
  EXPECT_NE(lines[0].separation, lines[1].separation);
}

TEST(SeparationLines, NoiseBreaksThemIntoPiecesAtMost) {
  double strength[2] = {0, 0};
  for (const SeparationLine& line : lines_of(torus(48), to_the_outer_equator, 0.5, 0.002)) {
    for (const Vec3d& p : line.points) {
      ASSERT_NEAR(std::hypot(p.x, p.y), line.separation ? 1.4 : 0.6, 0.02);
      ASSERT_NEAR(p.z, 0, 0.06) << "an edge is 0.05 long";
    }
    strength[line.separation] += line.strength;
  }
  for (const double sum : strength) EXPECT_NEAR(sum, once_round, 0.25 * once_round);
}

TEST(SeparationLines, TheFlowBackwardsHasTheOtherKind) {
  const auto backwards = [](const Vec3d& p) { return -to_the_outer_equator(p); };
  const std::vector<SeparationLine> lines = lines_of(torus(32), backwards, 2);
  ASSERT_EQ(lines.size(), 2u);
  for (const SeparationLine& line : lines)
    EXPECT_EQ(line.separation, std::hypot(line.points[0].x, line.points[0].y) < 1);
}

TEST(SeparationLines, ALineEndsAtARim) {
  const auto towards_the_middle = [](const Vec3d& p) { return Vec3d(1, -4 * p.y, 0); };
  const std::vector<SeparationLine> lines = lines_of(square(24), towards_the_middle);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].separation);
  EXPECT_NEAR(lines[0].strength, 4, 0.02) << "a way of 1 at a speed of 1";
  EXPECT_NEAR(std::fabs(lines[0].points.back().x - lines[0].points.front().x), 1, 1e-9);
  for (const Vec3d& p : lines[0].points) ASSERT_NEAR(p.y, 0, 1e-9);
}

TEST(SeparationLines, NoneWhereNothingComesTogether) {
  EXPECT_TRUE(lines_of(divided_sphere(4), [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); }).empty());
  EXPECT_TRUE(lines_of(square(24), [](const Vec3d&) { return Vec3d(1, 0.3, 0); }).empty());
  EXPECT_TRUE(lines_of(square(24), [](const Vec3d&) { return Vec3d{}; }).empty());
}

}  // namespace
}  // namespace nacre::test
