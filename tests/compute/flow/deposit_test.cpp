// Nacre: tests of the exact sums that particles leave.
#include "compute/flow/deposit.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

double mean(std::uint64_t word) { return double(Deposit::value(word)) / double(Deposit::weight(word)); }

TEST(Deposit, AgeTakesWeightAndLeavesTheMean) {
  std::uint64_t word = Deposit::pack(50000, 2 * Deposit::new_particle) + Deposit::pack(20000, Deposit::new_particle);
  EXPECT_EQ(Deposit::weight(word), 48u);
  EXPECT_DOUBLE_EQ(mean(word), 40000);
  word = Deposit::survivors(word, 4);
  EXPECT_EQ(Deposit::weight(word), 36u);
  EXPECT_DOUBLE_EQ(mean(word), 40000);
}

TEST(Deposit, ParticlesDieOutInTheEnd) {
  std::uint64_t word = Deposit::pack(65535, Deposit::new_particle);
  int steps = 0;
  for (; word != 0 && steps < 1000; ++steps) word = Deposit::survivors(word, 16);
  EXPECT_LT(steps, 100);
  EXPECT_EQ(Deposit::survivors(Deposit::pack(1, Deposit::new_particle), 1), 0u) << "a lifetime of one step";
  EXPECT_EQ(Deposit::survivors(0, 4), 0u);
}

/// All that flows into a sink is handed over again and again: no word may overflow into another.
TEST(Deposit, ASinkHoldsABoundedWeight) {
  std::uint64_t word = 0;
  for (int step = 0; step < 1000; ++step) {
    word = 0;
    for (int k = 0; k < 1000; ++k) word += Deposit::pack(65535, 1024);  // a thousand full cells end here
    word = Deposit::survivors(word, 16);
    ASSERT_EQ(Deposit::weight(word), Deposit::most_particles * Deposit::new_particle);
    ASSERT_DOUBLE_EQ(mean(word), 65535);
  }
}

TEST(Deposit, LinesCrossTheLargestDifferenceOfCells) {
  EXPECT_EQ(cells_crossed({0, 0, 0}), 0);
  EXPECT_EQ(cells_crossed({3, -7, 5}), 7);
  EXPECT_EQ(cells_crossed({-3, 2, -5}), 5);
}

}  // namespace
}  // namespace nacre
