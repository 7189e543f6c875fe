// Nacre: sums that do not depend on the order of their terms.
#include "compute/device/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace nacre {
namespace {

double sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms) sum.add(term);
  return sum.value();
}

TEST(ExactSum, AddsWhatCancels) {
  EXPECT_EQ(sum_of({}), 0.0);
  EXPECT_EQ(sum_of({1e300, 1, -1e300}), 1.0);
  EXPECT_EQ(sum_of({1e300, -1, -1e300}), -1.0);
  EXPECT_EQ(sum_of({0x1p-1074, 0x1p-1074}), 0x1p-1073);
  EXPECT_EQ(sum_of({-0x1p-1074, 3.5, -3.5}), -0x1p-1074);
  EXPECT_EQ(sum_of({1, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}), 1.0);
  EXPECT_EQ(sum_of({1e308, 1e308, -1e308}), 1e308);
  EXPECT_EQ(sum_of(std::vector<double>(10, 0.1)), 1.0) << "ten times what 0.1 is, rounded once";
}

TEST(ExactSum, DoesNotDependOnTheOrderNorOnWhoAddsWhat) {
  std::mt19937 random(7);
  std::vector<double> terms;
  for (int k = 0; k < 2000; ++k) terms.push_back(std::ldexp(double(random()) - 2e9, int(random() % 200) - 100));
  const double expected = sum_of(terms);
  for (int round = 0; round < 5; ++round) {
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(sum_of(terms), expected);
    ExactSum parts[3], whole, words;
    for (std::size_t k = 0; k < terms.size(); ++k) parts[k % 3].add(terms[k]);
    for (ExactSum& part : parts) {
      whole.add(part);
      const auto to = words.raw();
      for (std::size_t k = 0; k < to.size(); ++k) to[k] += part.raw()[k];
    }
    EXPECT_EQ(whole.value(), expected);
    EXPECT_EQ(words.value(), expected);
  }
}

}  // namespace
}  // namespace nacre
