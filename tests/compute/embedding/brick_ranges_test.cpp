// Nacre: ranges of bricks of equal work, and what lies around them.
#include "compute/embedding/brick_ranges.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "compute/flow/halo_depths.hpp"
#include "compute/math/morton.hpp"

namespace nacre {
namespace {

TEST(BrickRanges, HaveEqualWork) {
  std::mt19937 random(3);
  std::vector<std::uint64_t> work(1000);
  for (std::uint64_t& w : work) w = random() % 200;
  const auto whole = double(std::accumulate(work.begin(), work.end(), std::uint64_t(0)));
  for (const int parts : {1, 2, 3, 7, 64}) {
    const std::vector<std::size_t> begin = cut_by_work(work, parts);
    ASSERT_EQ(begin.size(), std::size_t(parts) + 1);
    EXPECT_EQ(begin.front(), 0u);
    EXPECT_EQ(begin.back(), work.size());
    for (int r = 0; r < parts; ++r) {
      const auto first = work.begin() + std::ptrdiff_t(begin[std::size_t(r)]);
      const auto last = work.begin() + std::ptrdiff_t(begin[std::size_t(r) + 1]);
      ASSERT_LE(first, last);
      EXPECT_NEAR(double(std::accumulate(first, last, std::uint64_t(0))), whole / parts, 200);
    }
  }
}

TEST(BrickRanges, AreEmptyWhereThereAreMoreThanBricks) {
  EXPECT_EQ(cut_by_work(std::vector<std::uint64_t>{5, 5}, 4), (std::vector<std::size_t>{0, 1, 1, 2, 2}));
  EXPECT_EQ(cut_by_work({}, 3), (std::vector<std::size_t>{0, 0, 0, 0}));
}

TEST(BrickRanges, KnowWhatLiesAround) {
  const int levels = 3, width = 1 << levels;
  std::vector<std::uint64_t> bricks{morton({0, 0, 0}), morton({4, 3, 6}), morton({7, 7, 7})};
  for (const int depth : {0, 1, 2, 5}) {
    std::vector<std::uint64_t> expected;
    for (std::uint64_t code = 0; code < std::uint64_t(width) * width * width; ++code) {
      const Int3 p = morton_cell(code);
      for (const std::uint64_t brick : bricks) {
        const Int3 d = p - morton_cell(brick);
        if (std::abs(d.x) > depth || std::abs(d.y) > depth || std::abs(d.z) > depth) continue;
        expected.push_back(code);
        break;
      }
    }
    EXPECT_EQ(codes_around(bricks, depth, levels), expected) << depth;
  }
  EXPECT_TRUE(codes_around({}, 3, levels).empty());
}

TEST(HaloDepths, AreAsDeepAsPathsAndStreaksAreLong) {
  const HaloDepths usual = HaloDepths::of(2.24, 8, 27);  // 21 cells of a path; 26 + 6 + 4 of a streak
  EXPECT_EQ(usual.deposits, 3);
  EXPECT_EQ(usual.beside, 1);
  EXPECT_EQ(usual.detail, 1);
  EXPECT_EQ(usual.whole, 5);
  const HaloDepths far = HaloDepths::of(2.24, 64, 0);
  EXPECT_EQ(far.deposits, 17);
  EXPECT_EQ(far.whole, far.deposits);
  EXPECT_EQ(HaloDepths::of(16, 8, 64).whole, 13);
}

}  // namespace
}  // namespace nacre
