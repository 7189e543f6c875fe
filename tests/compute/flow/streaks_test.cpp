// Nacre: streaks along the present flow on the CPU, and the directions that they are drawn by.
#include <random>

#include "compute/device/executor_cpu.hpp"
#include "compute/device/random.hpp"
#include "tests/compute/flow/streaks_body.hpp"

namespace nacre::test {
namespace {

StreakCells<Single> unpacked(const StreakCell& cell) { return load_streak_cells(&cell, 0, true); }

TEST(StreakCell, ZeroStaysZero) {
  const StreakCell cell = StreakCell::of({}, {}, 0);
  EXPECT_EQ(cell.direction, 0u);
  EXPECT_EQ(unpacked(cell).direction(), Vec3f());
  EXPECT_EQ(unpacked(cell).surface.plane(), 0);
}

TEST(StreakCell, AxesAreExact) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      Vec3f v{};
      v[axis] = side;
      EXPECT_EQ(unpacked(StreakCell::of(v, v, 0)).direction(), v);
      EXPECT_EQ(unpacked(StreakCell::of(v, v, 0)).surface.normal(), v);
    }
}

double degrees_between(const Vec3d& a, const Vec3d& b) { return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / pi; }

TEST(StreakCell, HoldsDirectionsToATenthOfADegreeAndNormalsToAHalf) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<float> plane(-0.866f, 0.866f);
  const auto direction = [&] { return normalized(Vec3d(normal(random), normal(random), normal(random))); };
  double flow = 0, surface = 0, height = 0;
  for (int k = 0; k < 100000; ++k) {
    const Vec3d v = direction(), n = direction();
    const float h = plane(random);
    const StreakCells<Single> back = unpacked(StreakCell::of(Vec3f(v), Vec3f(n), h));
    flow = std::max(flow, degrees_between(v, Vec3d(back.direction())));
    surface = std::max(surface, degrees_between(n, Vec3d(back.surface.normal())));
    height = std::max<double>(height, std::fabs(back.surface.plane() - h));
  }
  EXPECT_LT(flow, 0.1);
  EXPECT_LT(surface, 0.5);
  EXPECT_LT(height, 0.004) << "of a cell";
}

TEST(StreakSegment, HoldsItsEndsToAFortiethOfACellAndItsSum) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-6, 6), value(-3.3f, 3.3f);
  for (int k = 0; k < 100000; ++k) {
    const Vec3f ahead{place(random), place(random), place(random)}, behind{place(random), place(random), place(random)};
    const float sum = value(random), count = float(1 + k % 5);
    const std::uint32_t surface = random();
    const auto segment = element(StreakSegments<Single>::of(ahead, behind, sum, count, {std::int32_t(surface)}), 0);
    const StreakSegments<Single> back = load_streak_segments(&segment, 0, true);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(back.ahead()[axis], ahead[axis], 0.02501f);
      ASSERT_NEAR(back.behind()[axis], behind[axis], 0.02501f);
    }
    ASSERT_NEAR(back.sum(), sum, 0.0005);
    ASSERT_EQ(back.count(), count);
    ASSERT_EQ(std::uint32_t(back.surface.word), surface);
    ASSERT_TRUE(back.goes_ahead() && back.goes_behind());
  }
  const auto ended = StreakSegments<Single>::of({}, {}, -1.5f, 3, {});
  EXPECT_FALSE(ended.goes_ahead() || ended.goes_behind());
  EXPECT_EQ(ended.sum(), -1.5f);
}

/// Noise on a ball that turns about a slanted axis.
template <class Lanes = Widest>
DrawnStreaks on_a_ball(int threads, bool bricks) {
  const auto device = make_cpu_device(threads);
  Executor<Cpu> exec(*device);
  FlowSheet ball;
  ball.add(sphere({30.2, 30.1, 29.7}, 20.3, 24), {});
  for (std::size_t i = 0; i < ball.vectors.size(); ++i)
    ball.vectors[i] = Vec3f(cross(Vec3d(1, 2, 3), ball.mesh.points[i] - Vec3d(30.2, 30.1, 29.7)));
  const auto noise = [](const Int3& p) {
    return uniform_random(7, std::uint32_t((p.z * 64 + p.y) * 64 + p.x), 0) - 0.5f;
  };
  const StreakRecipe<decltype(noise)> recipe{noise, 16, true};
  return bricks ? draw_on_bricks<Lanes>(exec, ball, recipe) : draw_on_grid<Lanes>(exec, ball, recipe);
}

TEST(Streaks, AreTheSameOnAnyNumberOfThreads) {
  for (const bool bricks : {false, true}) {
    const DrawnStreaks one = on_a_ball(1, bricks), two = on_a_ball(2, bricks);
    EXPECT_GT(one.streaks.size(), 5000u);
    EXPECT_EQ(one.streaks, two.streaks);
    EXPECT_NE(one.streaks, one.value);
  }
}

TEST(Streaks, OfOneCellAtATimeAndOfManyAreTheSame) {
  for (const bool bricks : {false, true}) {
    SCOPED_TRACE(bricks ? "bricks" : "grid");
    const DrawnStreaks one = on_a_ball<Single>(2, bricks), many = on_a_ball(2, bricks);
    EXPECT_NE(one.streaks.size() % std::size_t(Widest::lanes), 0u) << "the last ones do not fill a packet";
    EXPECT_EQ(one.streaks, many.streaks);
  }
}

}  // namespace
}  // namespace nacre::test
