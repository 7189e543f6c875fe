// Nacre: interfaces by number, and which of them bound which.
#include "compute/embedding/junction_table.hpp"

#include <gtest/gtest.h>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

std::vector<std::uint32_t> related_to(const JunctionTable& table, std::size_t k) {
  return {table.related.begin() + table.start[k], table.related.begin() + table.start[k + 1]};
}

TEST(JunctionTable, AnInterfaceIsBoundByWhatHasAllOfItsMaterials) {
  const std::vector<Junction> interfaces{{0, 1}, {0, 1, 2}, {0, 2}, {1, 2}, {3, 4}};
  const std::vector<Junction> points{{0, 1, 2, 3}};
  const JunctionTable table = make_junction_table(interfaces, points);
  ASSERT_EQ(table.junctions.size(), 6u);
  EXPECT_EQ(table.order, (std::vector<std::uint8_t>{2, 1, 2, 2, 2, 0}));
  EXPECT_EQ(related_to(table, 0), (std::vector<std::uint32_t>{0, 1, 5}));  // itself first
  EXPECT_EQ(related_to(table, 1), (std::vector<std::uint32_t>{1, 5}));
  EXPECT_EQ(related_to(table, 3), (std::vector<std::uint32_t>{3, 1, 5}));
  EXPECT_EQ(related_to(table, 4), (std::vector<std::uint32_t>{4}));
  EXPECT_EQ(related_to(table, 5), (std::vector<std::uint32_t>{5}));
}

TEST(JunctionTable, KindsOfPointsComeOnceAndBehind) {
  const std::vector<Junction> interfaces{{0, 1}};
  const std::vector<Junction> points{{0, 1, 3, 4}, {0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 2, 3}};
  const JunctionTable table = make_junction_table(interfaces, points);
  EXPECT_EQ(table.junctions, (std::vector<Junction>{{0, 1}, {0, 1, 2, 3}, {0, 1, 3, 4}}));
  EXPECT_EQ(table.find({0, 1, 3, 4}), 2u);
  EXPECT_EQ(table.find({0, 1}), 0u);
  EXPECT_FALSE(table.find({0, 2}));
}

TEST(JunctionTable, ThereIsAnEnd) {
  std::vector<Junction> interfaces;
  for (std::uint32_t k = 0; k < most_interfaces; ++k) interfaces.push_back({k % 300, 300 + k / 300});
  EXPECT_EQ(make_junction_table(interfaces, {}).related.size(), most_interfaces);
  interfaces.push_back({0, 60000});
  EXPECT_THROW(make_junction_table(interfaces, {}), Error);
}

}  // namespace
}  // namespace nacre
