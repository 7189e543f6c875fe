// Nacre: Morton codes.
#include "compute/math/morton.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

static_assert(morton({23, 6, 14}) == 6649);
static_assert(morton({21, 6, 14}) == 6641);

TEST(Morton, InterleavesBits) {
  EXPECT_EQ(morton({23, 6, 14}), 6649u);
  EXPECT_EQ(morton({21, 6, 14}), 6641u);  // what sec. 6.1.2 prints
  EXPECT_EQ(morton({0, 0, 0}), 0u);
  EXPECT_EQ(morton({1, 0, 0}), 1u);
  EXPECT_EQ(morton({0, 1, 0}), 2u);
  EXPECT_EQ(morton({0, 0, 1}), 4u);
  EXPECT_EQ(morton({0x1fffff, 0x1fffff, 0x1fffff}), 0x7fffffffffffffffu);
}

TEST(Morton, TheInverseGivesTheCellBack) {
  for (int bit = 0; bit < 21; ++bit)
    for (int axis = 0; axis < 3; ++axis) {
      Int3 cell{3, 5, 6};
      cell[axis] ^= 1 << bit;
      EXPECT_EQ(morton_cell(morton(cell)), cell);
    }
  for (std::uint64_t code = 0; code < 4096; ++code) EXPECT_EQ(morton(morton_cell(code)), code);
}

TEST(Morton, TenBitsPerAxisFitIn32) { EXPECT_LT(morton({1023, 1023, 1023}), std::uint64_t(1) << 30); }

}  // namespace
}  // namespace nacre
