// Nacre: streaks along the present flow on the CPU, and the directions that they are drawn by.
#include <random>

#include "compute/device/executor_cpu.hpp"
#include "tests/compute/flow/streaks_body.hpp"

namespace nacre::test {
namespace {

TEST(PackedDirection, ZeroStaysZero) {
  EXPECT_EQ(PackedDirection::pack({0, 0, 0}), 0u);
  EXPECT_EQ(PackedDirection::unpack(0), Vec3f());
}

TEST(PackedDirection, AxesAreExact) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      Vec3f v{};
      v[axis] = side;
      EXPECT_EQ(PackedDirection::unpack(PackedDirection::pack(v)), v);
    }
}

TEST(PackedDirection, HoldsToATenthOfADegree) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int k = 0; k < 100000; ++k) {
    const Vec3d v = normalized(Vec3d(normal(random), normal(random), normal(random)));
    const Vec3d back(PackedDirection::unpack(PackedDirection::pack(Vec3f(v))));
    worst = std::max(worst, std::atan2(length(cross(v, back)), dot(v, back)));
  }
  EXPECT_LT(worst * 180 / pi, 0.1);
}

/// Noise on a ball that turns about a slanted axis.
DrawnStreaks on_a_ball(int threads, bool bricks) {
  const auto device = make_cpu_device(threads);
  Executor<Cpu> exec(*device);
  FlowSheet ball;
  ball.add(sphere({30, 30, 30}, 20, 24), {});
  for (std::size_t i = 0; i < ball.vectors.size(); ++i)
    ball.vectors[i] = Vec3f(cross(Vec3d(1, 2, 3), ball.mesh.points[i] - Vec3d(30, 30, 30)));
  const auto noise = [](const Int3& p) {
    return uniform_random(7, std::uint32_t((p.z * 64 + p.y) * 64 + p.x), 0) - 0.5f;
  };
  const StreakRecipe<decltype(noise)> recipe{noise, 16};
  return bricks ? draw_on_bricks(exec, ball, recipe) : draw_on_grid(exec, ball, recipe);
}

TEST(Streaks, AreTheSameOnAnyNumberOfThreads) {
  for (const bool bricks : {false, true}) {
    const DrawnStreaks one = on_a_ball(1, bricks), two = on_a_ball(2, bricks);
    EXPECT_GT(one.streaks.size(), 5000u);
    EXPECT_EQ(one.streaks, two.streaks);
    EXPECT_NE(one.streaks, one.value);
  }
}

}  // namespace
}  // namespace nacre::test
