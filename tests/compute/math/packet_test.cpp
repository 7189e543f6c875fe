// Nacre: packets compute what single numbers do.
#include "compute/math/packet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace nacre::test {
namespace {

#if defined(NACRE_PACKETS)

TEST(Packet, FloorsLikeOneNumber) {
  const float values[] = {0, -0.0f, 0.25f, -0.25f, 1, -1, 7.999f, -7.999f, 1e6f, -1e6f};
  for (const float a : values)
    for (int lane = 0; lane < Packet::lanes; ++lane) {
      Packet::Float p = Packet::all(3.5f);
      p[lane] = a;
      const Packet::Int floors = floor_to_int(p);
      EXPECT_EQ(floors[lane], floor_to_int(a)) << a;
      EXPECT_EQ(floors[(lane + 1) % Packet::lanes], 3);
    }
}

TEST(Packet, SignedBitsAreThoseOfOneNumber) {
  std::mt19937 random(5);
  for (int k = 0; k < 1000; ++k) {
    const auto word = std::int32_t(random());
    for (const int first : {0, 8, 10, 20})
      for (const int count : {4, 8, 10}) {
        const std::int32_t bits = word >> first & ((1 << count) - 1);
        const std::int32_t expected = bits >= 1 << (count - 1) ? bits - (1 << count) : bits;
        EXPECT_EQ(signed_bits(word, first, count), expected);
        EXPECT_EQ(signed_bits(Packet::all(word), first, count)[Packet::lanes - 1], expected);
      }
  }
}

TEST(Packet, GathersWhatIsNotMaskedOut) {
  std::vector<std::uint32_t> table(1000);
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = std::uint32_t(7 * i + 1);
  Packet::Int index{}, mask{};
  for (int lane = 0; lane < Packet::lanes; ++lane) {
    index[lane] = lane % 3 ? 61 * lane : -12345678;  // far outside, and masked out
    mask[lane] = lane % 3 ? -1 : 0;
  }
  const Packet::Int found = gather(table.data(), index, mask);
  for (int lane = 0; lane < Packet::lanes; ++lane) EXPECT_EQ(found[lane], lane % 3 ? 7 * 61 * lane + 1 : 0);
}

TEST(Packet, AnyIsTrueForOneLane) {
  EXPECT_FALSE(any(Packet::Mask{}));
  EXPECT_TRUE(any(Packet::nothing_masked()));
  for (int lane = 0; lane < Packet::lanes; ++lane) {
    Packet::Mask mask{};
    mask[lane] = -1;
    EXPECT_TRUE(any(mask)) << lane;
  }
}

#else

TEST(Packet, NeedsAvx2) { GTEST_SKIP() << "this build has no instructions that gather: one number at a time"; }

#endif

}  // namespace
}  // namespace nacre::test
