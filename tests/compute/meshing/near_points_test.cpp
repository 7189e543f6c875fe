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

struct Scattered {
  std::vector<Vec3d> points;
  std::vector<double> size;
  std::vector<std::uint32_t> some;  // every fifth
};

Scattered scattered_points() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(0, 20), any_size(0.1, 0.6);
  Scattered all;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    all.points.push_back({anywhere(random), anywhere(random), anywhere(random)});
    all.size.push_back(any_size(random));
    if (i % 5 == 0) all.some.push_back(i);
  }
  return all;
}

std::vector<std::uint32_t> expected_near(const Scattered& all, std::uint32_t point) {
  std::vector<std::uint32_t> near;
  for (const std::uint32_t i : all.some)
    if (length(all.points[i] - all.points[point]) <= reach * all.size[i]) near.push_back(i);
  return near;
}

TEST(NearPoints, AllPairsWithinReachAreVisited) {
  const Scattered all = scattered_points();
  std::vector<std::vector<std::uint32_t>> found(all.points.size());
  for_points_near(all.points, all.some, all.size, reach, [&](std::uint32_t point, std::span<const std::uint32_t> near) {
    EXPECT_TRUE(found[point].empty()) << "visited once";
    found[point].assign(near.begin(), near.end());
  });
  std::size_t with_several = 0, with_none = 0;
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    std::sort(found[i].begin(), found[i].end());
    EXPECT_EQ(found[i], expected_near(all, i)) << i;
    with_several += found[i].size() > 1, with_none += found[i].empty();
  }
  EXPECT_GT(with_several, 100u);
  EXPECT_GT(with_none, 100u);
}

TEST(NearPoints, MarksStayWhereTheyWere) {
  const Scattered all = scattered_points();
  std::vector<std::uint8_t> marks(all.points.size(), 0);
  std::uint32_t far = 0;
  while (!expected_near(all, far).empty()) ++far;
  marks[far] = 1;
  mark_near(all.points, all.some, all.size, reach, marks);
  for (std::uint32_t i = 0; i < marks.size(); ++i)
    EXPECT_EQ(marks[i] != 0, i == far || !expected_near(all, i).empty()) << i;
  mark_near(all.points, {}, all.size, reach, marks);  // none: nothing to do
}

}  // namespace
}  // namespace nacre::test
