// Nacre: closest points of eight positions at once against those of each position by itself.
#include "compute/embedding/closest_of_eight.hpp"

#include <gtest/gtest.h>

#include <random>

namespace nacre {
namespace {

Vec3d corner(const Vec3d& centre, double half, int k) {
  return centre + Vec3d(k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half);
}

TEST(ClosestOfEight, AgreesWithOnePlaceAtATime) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> position(-4, 4);
  auto point = [&] { return Vec3d(position(random), position(random), position(random)); };
  int compared = 0;
  for (int round = 0; round < 20000; ++round) {
    const double far = round % 3 == 0 ? 1e6 : 0, size = round % 2 ? 1 : 0.1;
    const Corners t = Corners{point(), point(), point()} * size;
    const Corners moved{t.a + Vec3d(far), t.b + Vec3d(far), t.c + Vec3d(far)};
    const Vec3d centre = point() + Vec3d(far);
    ClosestOfEight found;
    if (!closest_of_eight(moved, centre, 0.5, found)) continue;
    for (int k = 0; k < 8; ++k, ++compared) {
      const Vec3d x = corner(centre, 0.5, k), d = closest_point(moved, x) - x;
      ASSERT_NEAR(length(Vec3d(found.x[k], found.y[k], found.z[k]) - d), 0, 2e-9 + 1e-14 * far) << round << ' ' << k;
      ASSERT_NEAR(found.squared[k], dot(d, d), 1e-7);
    }
  }
  EXPECT_GT(compared, 100000);
}

TEST(ClosestOfEight, LeavesSliversAlone) {
  ClosestOfEight found;
  const Vec3d a(0.0), b(1, 0, 0), c(2, 1e-7, 0);
  EXPECT_FALSE(closest_of_eight({a, b, c}, Vec3d(1, 1, 1), 0.5, found));
  EXPECT_FALSE(closest_of_eight({a, a, a}, Vec3d(1, 1, 1), 0.5, found));
}

}  // namespace
}  // namespace nacre
