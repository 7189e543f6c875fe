// Nacre: tests of vectors in four bytes.
#include "compute/flow/packed_vector.hpp"

#include <gtest/gtest.h>

#include <random>

namespace nacre {
namespace {

TEST(PackedVector, ZeroStaysZero) {
  const Vec3f v = PackedVector::unpack(PackedVector::pack({0, 0, 0}));
  EXPECT_EQ(v, Vec3f());
}

TEST(PackedVector, PowersOfTwoAreExact) {
  for (const float x : {0.25f, 1.0f, 8.0f, 128.0f}) {
    const Vec3f v = PackedVector::unpack(PackedVector::pack({x, -x, 0}));
    EXPECT_EQ(v, Vec3f(x, -x, 0)) << x;
  }
}

TEST(PackedVector, DirectionAndLengthHoldAtEveryScale) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int k = 0; k < 20000; ++k) {
    const Vec3f v = Vec3f(normal(random), normal(random), normal(random)) * std::ldexp(1.0f, k % 24 - 18);
    const Vec3f back = PackedVector::unpack(PackedVector::pack(v));
    EXPECT_LE(length(back - v), 0.0068f * length(v)) << v.x << ' ' << v.y << ' ' << v.z;
  }
}

TEST(PackedVector, LongestAndShortestAreClamped) {
  EXPECT_EQ(PackedVector::unpack(PackedVector::pack({5000, -5000, 0})), Vec3f(1020, -1020, 0));
  EXPECT_EQ(PackedVector::unpack(PackedVector::pack({1e-12f, 0, 0})), Vec3f());
}

TEST(PackedVector, TheSumIsThatOfTheParts) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  for (int k = 0; k < 1000; ++k) {
    std::uint32_t p[8];
    float w[8];
    Vec3f expected{};
    for (int j = 0; j < 8; ++j) {
      p[j] = PackedVector::pack({normal(random) * 10, normal(random), normal(random) * 0.01f});
      w[j] = normal(random);
      expected += PackedVector::unpack(p[j]) * w[j];
    }
    EXPECT_LE(length(PackedVector::sum(p, w) - expected), 1e-4f);
  }
}

}  // namespace
}  // namespace nacre
