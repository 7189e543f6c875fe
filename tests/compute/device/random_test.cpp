// Nacre: the counter-based random numbers against their published answers.
#include "compute/device/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace nacre {
namespace {

TEST(Random, PhiloxGivesThePublishedNumbers) {  // known answers of Random123 for philox2x32-10
  struct {
    std::uint32_t low, high, key, a, b;
  } const known[] = {{0, 0, 0, 0xff1dae59, 0x6cd10df2},
                     {0xffffffff, 0xffffffff, 0xffffffff, 0x2c3f628b, 0xab4fd7ad},
                     {0x243f6a88, 0x85a308d3, 0x13198a2e, 0xdd7ce038, 0xf62a4c12}};
  for (const auto& k : known) {
    const Random2 r = philox(k.low, k.high, k.key);
    EXPECT_EQ(r.a, k.a);
    EXPECT_EQ(r.b, k.b);
  }
}

TEST(Random, EveryPartOfTheCounterMatters) {
  const float one = uniform_random(1, 2, 3);
  EXPECT_EQ(one, uniform_random(1, 2, 3));
  EXPECT_NE(one, uniform_random(2, 2, 3));
  EXPECT_NE(one, uniform_random(1, 3, 3));
  EXPECT_NE(one, uniform_random(1, 2, 4));
}

TEST(Random, UniformNumbersFillTheUnitIntervalEvenly) {
  constexpr int n = 100000, bins = 10;
  std::array<int, bins> histogram{};
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const float u = uniform_random(7, i, 0);
    ASSERT_GE(u, 0.0f);
    ASSERT_LT(u, 1.0f);
    ++histogram[std::size_t(u * bins)];
    sum += u;
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * 0.29 / std::sqrt(n));
  for (const int count : histogram) EXPECT_NEAR(count, n / bins, 500);  // five standard deviations
}

}  // namespace
}  // namespace nacre
