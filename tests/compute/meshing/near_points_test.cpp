// Nacre: points near some of them are those that a comparison of all pairs finds.
#include "compute/meshing/near_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace nacre::test {
namespace {

constexpr double reach = 3;

struct Cloud {
  std::vector<Vec3d> points;
  std::vector<double> size;
  std::vector<std::uint32_t> some;  // every fifth
};

Cloud random_cloud() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(0, 20), any_size(0.1, 0.6);
  Cloud cloud;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    cloud.points.push_back({anywhere(random), anywhere(random), anywhere(random)});
    cloud.size.push_back(any_size(random));
    if (i % 5 == 0) cloud.some.push_back(i);
  }
  return cloud;
}

std::vector<std::uint32_t> expected_near(const Cloud& cloud, std::uint32_t point) {
  std::vector<std::uint32_t> near;
  for (const std::uint32_t i : cloud.some)
    if (length(cloud.points[i] - cloud.points[point]) <= reach * cloud.size[i]) near.push_back(i);
  return near;
}

TEST(NearPoints, AllPairsWithinReachAreVisited) {
  const Cloud cloud = random_cloud();
  std::vector<std::vector<std::uint32_t>> found(cloud.points.size());
  for_points_near(cloud.points, cloud.some, cloud.size, reach,
                  [&](std::uint32_t point, std::span<const std::uint32_t> near) {
                    EXPECT_TRUE(found[point].empty()) << "visited once";
                    found[point].assign(near.begin(), near.end());
                  });
  std::size_t with_several = 0, with_none = 0;
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    std::sort(found[i].begin(), found[i].end());
    EXPECT_EQ(found[i], expected_near(cloud, i)) << i;
    with_several += found[i].size() > 1, with_none += found[i].empty();
  }
  EXPECT_GT(with_several, 100u);
  EXPECT_GT(with_none, 100u);
}

TEST(NearPoints, MarksStayWhereTheyWere) {
  const Cloud cloud = random_cloud();
  std::vector<std::uint8_t> marks(cloud.points.size(), 0);
  std::uint32_t far = 0;
  while (!expected_near(cloud, far).empty()) ++far;
  marks[far] = 1;
  mark_near(cloud.points, cloud.some, cloud.size, reach, marks);
  for (std::uint32_t i = 0; i < marks.size(); ++i)
    EXPECT_EQ(marks[i] != 0, i == far || !expected_near(cloud, i).empty()) << i;
  mark_near(cloud.points, {}, cloud.size, reach, marks);  // none: nothing to do
}

}  // namespace
}  // namespace nacre::test
