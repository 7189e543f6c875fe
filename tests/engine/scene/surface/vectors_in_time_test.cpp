// Nacre: tests of vectors and colours between the steps of a series.
#include "engine/scene/surface/vectors_in_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "compute/device/error.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre {
namespace {

/// Step k of a cube: the vector (k^2 + 1, 0, 0) and the scalar 10 k^2 everywhere.
SurfaceSeries squares(std::size_t steps) {
  SurfaceSeries series;
  series.name = "squares";
  for (std::size_t k = 0; k < steps; ++k) series.times.push_back(double(k));
  series.load = [](std::size_t k) {
    Surface surface = test::cube();
    PointArray v{"v", 3, {}}, s{"s", 1, {}};
    for (std::size_t p = 0; p < surface.points.size(); ++p) {
      v.values.insert(v.values.end(), {float(k * k + 1), 0, 0});
      s.values.push_back(float(10 * k * k));
    }
    surface.arrays = {v, s};
    return surface;
  };
  return series;
}

VectorsInTime squares_in_time(std::size_t steps) {
  SurfaceSeries series = squares(steps);
  PreparedSurface surface = prepare(series.load(0));
  return {std::move(series), std::move(surface), "v", "s"};
}

/// What `squares` should give at `t`: straight lines between the steps.
double expected(double t, std::size_t steps) {
  t = std::clamp(t, 0.0, double(steps - 1));
  const double k = std::floor(t);
  return k * k + (t - k) * (2 * k + 1);
}

TEST(VectorsInTime, LiesBetweenTheTwoStepsAroundItInAnyOrderOfTimes) {
  constexpr std::size_t steps = 5;
  VectorsInTime input = squares_in_time(steps);
  std::vector<double> times;
  for (double t = -0.75; t < steps; t += 0.75) times.push_back(t);
  // Any two times before the third leave any two steps in memory.
  for (const double first : times)
    for (const double second : times)
      for (const double third : times)
        for (const double t : {first, second, third}) {
          std::vector<Vec3f> v(input.surface().points.size());
          input.vectors(t, v);
          ASSERT_NEAR(v[0].x, expected(t, steps) + 1, 1e-5) << first << ' ' << second << ' ' << third << " at " << t;
          ASSERT_NEAR(input.scalar(t)[3], 10 * expected(t, steps), 1e-4) << t;
        }
}

TEST(VectorsInTime, AStepThatCannotBeReadLeavesTheOthers) {
  SurfaceSeries series = squares(4);
  PreparedSurface surface = prepare(series.load(0));
  bool broken = false;
  series.load = [&broken, load = series.load](std::size_t k) {
    if (broken && k == 2) throw Error("gone");
    return load(k);
  };
  VectorsInTime input(std::move(series), std::move(surface), "v", "none");
  std::vector<Vec3f> v(input.surface().points.size());
  input.vectors(0.5, v);
  broken = true;
  EXPECT_THROW(input.vectors(1.5, v), Error);
  EXPECT_THROW(input.vectors(1.5, v), Error);
  input.vectors(0.5, v);
  EXPECT_NEAR(v[0].x, 1.5, 1e-5);
}

TEST(VectorsInTime, RangeOfTheColoursIsThatOfAllSteps) {
  const VectorsInTime input = squares_in_time(4);
  EXPECT_EQ(input.color_spread().low, 0);
  EXPECT_EQ(input.color_spread().high, 90);
  EXPECT_EQ(input.start(), 0);
  EXPECT_EQ(input.end(), 3);
}

}  // namespace
}  // namespace nacre
