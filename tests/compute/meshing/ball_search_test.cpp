// Nacre: tests of the search for points within balls.
#include "compute/meshing/ball_search.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

TEST(BallSearch, FindsWhatAFullSearchFinds) {
  std::vector<Vec3d> points = test::points_on_sphere(20000, 2);
  for (int i = 0; i < 4000; ++i) points.push_back({i % 10 * 0.1, i / 10 % 20 * 0.1, i / 200 * 0.1});  // rows of equals
  const BallSearch search(points);
  for (const double radius : {0.01, 0.15, 1.0, 5.0})
    for (std::size_t c = 0; c < points.size(); c += 3331) {
      std::set<std::uint32_t> found, expected;
      search.visit_within(points[c], radius, [&](std::uint32_t i) { EXPECT_TRUE(found.insert(i).second); });
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d to = points[i] - points[c];
        if (dot(to, to) < radius * radius) expected.insert(std::uint32_t(i));
      }
      ASSERT_EQ(found, expected) << radius;
    }
  BallSearch(std::span<const Vec3d>()).visit_within({0, 0, 0}, 1, [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace nacre
