// Nacre: sets that many threads join at once are those that one thread makes.
#include "compute/math/disjoint_sets.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <random>

namespace nacre::test {
namespace {

constexpr std::uint32_t members = 20000;

std::vector<std::array<std::uint32_t, 2>> random_pairs(std::size_t count) {
  std::mt19937 random(7);
  std::vector<std::array<std::uint32_t, 2>> pairs(count);
  for (auto& [a, b] : pairs) a = std::uint32_t(random() % members), b = std::uint32_t(random() % members);
  return pairs;
}

TEST(DisjointSets, EachIsKnownByItsSmallestMember) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.join(5, 3), 3);
  EXPECT_EQ(sets.join(4, 5), 3);
  EXPECT_EQ(sets.join(1, 4), 1);
  EXPECT_EQ(sets.join(4, 1), 1);
  EXPECT_EQ(sets.find(5), 1);
  EXPECT_EQ(sets.find(2), 2);
}

TEST(DisjointSets, ManyThreadsMakeTheSetsOfOne) {
  // About as many pairs as make one large set and many small ones.
  const auto pairs = random_pairs(members * 6 / 10);
  DisjointSets by_one(members), by_many(members);
  for (const auto& [a, b] : pairs) by_one.join(a, b);
  tbb::parallel_for(std::size_t(0), pairs.size(), [&](std::size_t i) { by_many.join(pairs[i][0], pairs[i][1]); });
  std::size_t sets = 0, moved = 0;
  for (std::uint32_t i = 0; i < members; ++i) {
    EXPECT_EQ(by_many.find(i), by_one.find(i)) << i;
    ++(by_one.find(i) == i ? sets : moved);
  }
  EXPECT_GT(sets, 1000u);
  EXPECT_GT(moved, 1000u);
}

}  // namespace
}  // namespace nacre::test
