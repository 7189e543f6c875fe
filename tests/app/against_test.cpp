// Nacre: tests of the guard against losses, on reports made by hand.
#include "app/bench/against.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

using nlohmann::json;

json report_of(const char* better, double ours) {
  const json value = {{"ours", ours}, {"better", better}};
  return {{"tables", {{{"name", "3.1"}, {"rows", {{{"name", "heart"}, {"values", {{"a / b", value}}}}}}}}}};
}

RunComparison compare(const char* better, double now, double last) {
  return compare_runs(report_of(better, now), report_of(better, last), {});
}

TEST(Against, ALossBeginsAtThirtyPerCent) {
  EXPECT_TRUE(compare("higher", 0.71, 1).losses.empty());
  EXPECT_EQ(compare("higher", 0.69, 1).losses.size(), 1u);
  EXPECT_TRUE(compare("lower", 1, 0.71).losses.empty());
  EXPECT_EQ(compare("lower", 1, 0.69).losses.size(), 1u);
}

TEST(Against, AGainIsNoLoss) {
  for (const auto& result : {compare("higher", 50, 1), compare("lower", 1, 50)}) {
    EXPECT_EQ(result.compared, 1);
    EXPECT_TRUE(result.losses.empty() && result.missing.empty());
  }
}

TEST(Against, ALossIsToldWithItsPlaceAndBothFigures) {
  const std::string told = compare("higher", 0.5, 2).losses.at(0);
  EXPECT_EQ(told, "Table 3.1, heart, a / b: 0.5, was 2 (higher is better)");
}

}  // namespace
}  // namespace nacre
