// Nacre: ticks are round, few and within the range.
#include "engine/picture/ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace nacre {
namespace {

using Labels = std::vector<std::string>;

TEST(Ticks, RoundNumbers) {
  EXPECT_EQ(nice_ticks(0, 47.3, 6).labels, (Labels{"0", "10", "20", "30", "40"}));
  EXPECT_EQ(nice_ticks(0, 1, 5).labels, (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(nice_ticks(-2.1, 2.1, 4).labels, (Labels{"\u22122", "0", "2"}));
  EXPECT_EQ(nice_ticks(101325.01, 101325.42, 5).exponent, 3);
}

TEST(Ticks, PowersAreTakenOut) {
  const Ticks small = nice_ticks(0, 2e-5, 4), large = nice_ticks(0, 3.1e6, 4);
  EXPECT_EQ(small.exponent, -6);
  EXPECT_EQ(small.labels, (Labels{"0", "5", "10", "15", "20"}));
  EXPECT_EQ(large.exponent, 6);
  EXPECT_EQ(large.labels, (Labels{"0", "1", "2", "3"}));
  EXPECT_EQ(nice_ticks(0, 99999, 5).exponent, 0);
  EXPECT_EQ(nice_ticks(0, 0.001, 5).exponent, 0);
}

TEST(Ticks, WithinTheRangeForEveryScale) {
  for (int e = -30; e <= 30; ++e)
    for (const double low : {-1.0, -0.37, 0.0, 0.61}) {
      const double scale = std::pow(10.0, e), min = low * scale, max = 1.7 * scale;
      const Ticks ticks = nice_ticks(min, max, 6);
      ASSERT_GE(ticks.values.size(), 2u) << min << " " << max;
      ASSERT_LE(ticks.values.size(), 7u) << min << " " << max;
      ASSERT_EQ(ticks.values.size(), ticks.labels.size());
      for (std::size_t i = 0; i < ticks.values.size(); ++i) {
        EXPECT_GE(ticks.values[i], min);
        EXPECT_LE(ticks.values[i], max);
        EXPECT_LE(ticks.labels[i].size(), std::string("\u22120.0001").size()) << ticks.labels[i];
        if (i == 0) continue;
        EXPECT_NE(ticks.labels[i], ticks.labels[i - 1]);
      }
    }
}

TEST(Ticks, NoRange) {
  EXPECT_EQ(nice_ticks(3, 3, 5).labels, (Labels{"3"}));
  EXPECT_EQ(nice_ticks(0, 0, 5).labels, (Labels{"0"}));
  EXPECT_EQ(nice_ticks(1e9, 1e9 + 1e-3, 5).values.size(), 1u);
  const double inf = std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::max();
  EXPECT_TRUE(nice_ticks(0, inf, 5).values.empty());
  EXPECT_TRUE(nice_ticks(std::nan(""), 1, 5).values.empty());
  EXPECT_TRUE(nice_ticks(-most, most, 5).values.empty());
  EXPECT_GE(nice_ticks(0, most, 5).values.size(), 2u);
  EXPECT_EQ(nice_ticks(0, 5e-324, 5).values.size(), 1u);
}

TEST(Numbers, AsText) {
  EXPECT_EQ(fixed_number(-0.25, 2), "\u22120.25");
  EXPECT_EQ(fixed_number(-0.001, 1), "0.0");
  EXPECT_EQ(short_number(0.125, 4), "0.125");
  EXPECT_EQ(short_number(1.5e-7, 4), "1.5\u00d710\u207b\u2077");
  EXPECT_EQ(short_number(2e12, 4), "2\u00d710\u00b9\u00b2");
  EXPECT_EQ(power_of_ten(-3), "\u00d710\u207b\u00b3");
}

}  // namespace
}  // namespace nacre
