// Nacre: convex hulls of a few points.
#include "compute/meshing/small_hull.hpp"

#include <gtest/gtest.h>

#include "tests/compute/meshing/star_clouds.hpp"

namespace nacre::test {
namespace {

double enclosed(const std::vector<Vec3d>& points, const std::vector<Triangle>& hull) {
  double six = 0;
  for (const Triangle& t : hull) six += dot(points[t.a], cross(points[t.b], points[t.c]));
  return six / 6;
}

TEST(SmallHull, HasAllPointsOfASphereAndNoneWithin) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::vector<Vec3d> points = random_directions(int(4 + seed % 20), seed);
    const std::size_t outer = points.size();
    const std::vector<Triangle> alone = small_hull(points);
    if (outer >= 12) points.push_back(points[0] * 0.05);  // fewer may lie on one side
    const std::vector<Triangle> hull = small_hull(points);
    if (hull.empty()) continue;  // four or five of them lie in a plane nearly
    EXPECT_EQ(hull.size(), 2 * outer - 4) << seed;
    EXPECT_EQ(hull.size(), alone.size());
    EXPECT_GT(enclosed(points, hull), 0);
    for (const Triangle& t : hull) {
      const Vec3d n = cross(points[t.b] - points[t.a], points[t.c] - points[t.a]);
      for (const Vec3d& p : points) EXPECT_LT(dot(n, p - points[t.a]), 1e-3) << seed;
    }
  }
}

TEST(SmallHull, OfACubeIsClosedAndOfAPlaneIsNone) {
  std::vector<Vec3d> cube, plane;
  for (int i = 0; i < 8; ++i) cube.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  for (int i = 0; i < 9; ++i) plane.push_back({double(i % 3), double(i / 3), 1});
  EXPECT_EQ(small_hull(cube).size(), 12u);
  EXPECT_NEAR(enclosed(cube, small_hull(cube)), 1, 1e-9);
  EXPECT_TRUE(small_hull(plane).empty());
  EXPECT_TRUE(small_hull(std::vector<Vec3d>(5, Vec3d(1, 2, 3))).empty());
  EXPECT_TRUE(small_hull(std::span(cube).first(3)).empty());
}

}  // namespace
}  // namespace nacre::test
