// Nacre: tests of means of wall shear stress over time.
#include "engine/scene/surface/haemodynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compute/device/error.hpp"
#include "tests/engine/scene/surface/moving_series.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre::test {
namespace {

constexpr double pi = std::numbers::pi;

/// tau(t) on the points of a sphere that does not move, in `n` steps over a period of 2.
VectorsInTime stress(std::size_t n, const std::function<Vec3f(double)>& tau, const std::string& color,
                     bool repeats = false) {
  SurfaceSeries series;
  for (std::size_t k = 0; k < n + (repeats ? 1 : 0); ++k) series.times.push_back(2 * double(k) / double(n));
  series.load = [times = series.times, tau](std::size_t k) {
    Surface s = icosphere(1);
    PointArray array{"wss", 3, {}};
    for (std::size_t i = 0; i < s.points.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) array.values.push_back(tau(times[k])[axis]);
    s.arrays = {array};
    return s;
  };
  PreparedSurface surface = prepare(series.load(0));
  MotionChoice motion;
  motion.period = 2;
  return {std::move(series), std::move(surface), "wss", color, nullptr, motion};
}

TEST(Haemodynamics, AreThoseOfAKnownStress) {
  // 1 + 2 sin(pi t) along x: it turns back where sin < -1/2, for a third of the period.
  const auto tau = [](double t) { return Vec3f(float(1 + 2 * std::sin(pi * t)), 0, 0); };
  const double magnitude = 1.0 / 3 + 2 * std::sqrt(3.0) / pi;  // mean of |1 + 2 sin|
  for (const bool repeats : {false, true}) {
    VectorsInTime input = stress(256, tau, "none", repeats);
    const Haemodynamics all = haemodynamics(input);
    for (std::size_t i = 0; i < all.osi.size(); ++i) {
      ASSERT_NEAR(all.tawss[i], magnitude, 1e-3);
      ASSERT_NEAR(all.osi[i], 0.5 * (1 - 1 / magnitude), 1e-3);
      ASSERT_NEAR(all.rrt[i], 1 / ((1 - 2 * all.osi[i]) * all.tawss[i]), 1e-3);
      ASSERT_NEAR(all.rrt[i], 1, 1e-3) << "the mean of tau is 1";
    }
  }
}

TEST(Haemodynamics, TheirLimits) {
  VectorsInTime steady = stress(
      8, [](double) { return Vec3f(0, 3, 0); }, "none");
  EXPECT_FLOAT_EQ(haemodynamics(steady).tawss[0], 3);
  EXPECT_FLOAT_EQ(haemodynamics(steady).osi[0], 0);
  VectorsInTime back_and_forth = stress(
      8, [](double t) { return Vec3f(float(std::cos(pi * t)), 0, 0); }, "none");
  EXPECT_NEAR(haemodynamics(back_and_forth).osi[0], 0.5, 1e-6);
  VectorsInTime nothing = stress(
      8, [](double) { return Vec3f(); }, "none");
  EXPECT_EQ(haemodynamics(nothing).tawss[0], 0);
  EXPECT_EQ(haemodynamics(nothing).osi[0], 0);
  EXPECT_TRUE(std::isnan(haemodynamics(nothing).rrt[0]));
}

TEST(Haemodynamics, ColourTheSurface) {
  const auto tau = [](double t) { return Vec3f(float(1 + 2 * std::sin(pi * t)), 0, 0); };
  VectorsInTime input = stress(64, tau, "osi");
  EXPECT_EQ(input.scalar(0.3), haemodynamics(input).osi);
  EXPECT_EQ(input.scalar(0.3), input.scalar(1.7)) << "a mean over time";
  input.set_color("TAWSS");
  EXPECT_EQ(input.scalar(1), haemodynamics(input).tawss);
}

TEST(Haemodynamics, AWallThatTurnsDoesNotMakeAStressOscillate) {
  const auto turn = [](const Vec3d& p, double t) {
    const double c = std::cos(2 * pi * t), s = std::sin(2 * pi * t);
    return Vec3d(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
  };
  SurfaceSeries series = examine_motion(moving_series(64,
                                                      [&](double t) {
                                                        Surface s = icosphere(2);
                                                        PointArray wss{"wss", 3, {}};
                                                        for (Vec3d& p : s.points) {
                                                          const Vec3d v = turn(Vec3d(-p.y, p.x, 0) * 2.0, t);
                                                          for (int k = 0; k < 3; ++k) wss.values.push_back(float(v[k]));
                                                          p = turn(p, t);
                                                        }
                                                        s.arrays = {wss};
                                                        return s;
                                                      }),
                                        [](const std::string&) {});
  PreparedSurface surface = prepare(series.load(0));
  VectorsInTime input(std::move(series), std::move(surface), "wss", "none");
  const Haemodynamics all = haemodynamics(input);
  for (std::size_t i = 0; i < all.osi.size(); ++i) {
    const Vec3d& p = input.surface().points[i];
    ASSERT_NEAR(all.osi[i], 0, 1e-3);
    ASSERT_NEAR(all.tawss[i], 2 * std::hypot(p.x, p.y), 1e-3);
  }
}

}  // namespace
}  // namespace nacre::test
