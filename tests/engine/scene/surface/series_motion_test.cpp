// Nacre: what is made of the shapes of a series: bad ones, relative velocities, vectors on other shapes, periods.
#include "engine/scene/surface/series_motion.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "compute/device/error.hpp"
#include "engine/scene/surface/material_map.hpp"
#include "tests/engine/scene/surface/moving_series.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre::test {
namespace {

Vec3d still(const Vec3d& p, double) { return p; }

/// Ten steps of a sphere, of which the fourth is what `spoil` makes of it; what is said, and the steps left.
std::pair<std::string, std::size_t> examined(const std::function<void(Surface&)>& spoil) {
  const SurfaceSeries series = moving_series(9, [&](double t) {
    Surface s = moved(icosphere(2), t, still);
    if (std::abs(t - 3.0 / 9) < 1e-9) spoil(s);
    return s;
  });
  std::string said;
  const SurfaceSeries after = examine_motion(series, [&](const std::string& sentence) { said += sentence; });
  EXPECT_EQ(after.motion->group.size(), after.steps());
  EXPECT_EQ(after.motion->groups, 1u) << "what is left out changes nothing";
  for (std::size_t k = 0; k < after.steps(); ++k) EXPECT_EQ(after.load(k).points, icosphere(2).points);
  return {said, after.steps()};
}

TEST(SeriesMotion, StepsThatCannotBeTrueAreLeftOutWithAReason) {
  const auto expect = [](const std::string& words, const std::function<void(Surface&)>& spoil) {
    const auto [said, steps] = examined(spoil);
    EXPECT_NE(said.find("step 3 (time 0.333333) is left out"), std::string::npos) << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_EQ(steps, 9u);
  };
  expect("vanishes: it has no triangles", [](Surface& s) { s.triangles.clear(); });
  expect("vanishes: it has no extent", [](Surface& s) { s.points.assign(s.points.size(), Vec3d(1)); });
  expect("not all finite", [](Surface& s) { s.points[7].y = std::numeric_limits<double>::quiet_NaN(); });
  expect("1e+03 times as large", [](Surface& s) {
    for (Vec3d& p : s.points) p *= 1000;
  });
  expect("0.1 times as large", [](Surface& s) {
    for (Vec3d& p : s.points) p *= 0.1;
  });
  expect("turned inside out", [](Surface& s) {
    for (Vec3d& p : s.points) p.x = -p.x;
  });
  const auto [said, steps] = examined([](Surface&) {});
  EXPECT_EQ(said, "");
  EXPECT_EQ(steps, 10u);
}

TEST(SeriesMotion, NoUsableStepIsAnError) {
  const SurfaceSeries series = moving_series(3, [](double) { return Surface(); });
  EXPECT_THROW(examine_motion(series, [](const std::string&) {}), Error);
}

TEST(SeriesMotion, StepsOfTheSameTrianglesAreGroups) {
  const SurfaceSeries series = moving_series(5, [](double t) { return moved(icosphere(t < 0.5 ? 1 : 2), t, still); });
  const SurfaceSeries after = examine_motion(series, [](const std::string& sentence) { FAIL() << sentence; });
  EXPECT_EQ(after.motion->group, (std::vector<std::size_t>{0, 0, 0, 1, 1, 1}));
}

TEST(MaterialMap, RigidMotionsTurnVectorsExactly) {
  const Surface s = icosphere(2);
  const auto turn = [](const Vec3d& p) { return Vec3d(-p.y, p.x, p.z); };
  std::vector<Vec3d> to;
  std::vector<Vec3f> vectors, turned(s.points.size());
  for (const Vec3d& p : s.points) {
    to.push_back(turn(p) + Vec3d(1, 2, 3));
    vectors.emplace_back(Vec3d(p.z, 1, p.x * p.y));
  }
  transfer_vectors(s.points, to, s.triangles, vectors, turned);
  for (std::size_t i = 0; i < turned.size(); ++i) ASSERT_LT(length(turned[i] - Vec3f(turn(Vec3d(vectors[i])))), 1e-5f);
  EXPECT_EQ(distorted_share(s.points, to, s.triangles, 1.0001), 0);
}

TEST(MaterialMap, VectorsAreStretchedWithTheSurface) {
  const Surface s = plate(3);
  std::vector<Vec3d> to;
  for (const Vec3d& p : s.points) to.emplace_back(2 * p.x + 0.5 * p.y, p.y, 0);
  const std::vector<Vec3f> vectors(s.points.size(), Vec3f(1, 2, 0));
  std::vector<Vec3f> result(s.points.size());
  transfer_vectors(s.points, to, s.triangles, vectors, result);
  for (const Vec3f& v : result) ASSERT_LT(length(v - Vec3f(3, 2, 0)), 1e-5f);
  EXPECT_EQ(distorted_share(s.points, to, s.triangles, 1.5), 1);
  EXPECT_EQ(distorted_share(s.points, to, s.triangles, 2.5), 0);
}

/// What is decided for a moving sphere with this array.
MotionChoice decided(const std::string& array, Settings settings, std::string* said = nullptr) {
  SurfaceSeries series = moving_series(4, [&](double t) {
    Surface s = moved(icosphere(1), t, [](const Vec3d& p, double u) { return p * (1 + 0.1 * u); });
    s.arrays[0].name = array;
    return s;
  });
  FlowLog log;
  log.warn = [&](const std::string& sentence) {
    if (said) *said += sentence + "\n";
  };
  log.chosen = [](const VectorChoice&) {};
  settings.vectors = array;
  return make_flow_input(std::move(series), settings, log).motion();
}

TEST(RelativeVectors, VelocitiesAreWallShearNeverIs) {
  Settings automatic, on, off;
  on.relative = RelativeVectors::on;
  off.relative = RelativeVectors::off;
  std::string said;
  EXPECT_TRUE(decided("velocity", automatic, &said).relative);
  EXPECT_NE(said.find("velocity is shown relative to the surface, whose velocity is from its positions"),
            std::string::npos)
      << said;
  EXPECT_FALSE(decided("velocity", off, &said).relative);
  EXPECT_NE(said.find("is shown as it is, not relative"), std::string::npos) << said;
  EXPECT_FALSE(decided("wallShearStress", automatic).relative);
  EXPECT_FALSE(decided("wallShearStress", on, &said).relative);
  EXPECT_NE(said.find("wall shear stress: it is never changed"), std::string::npos) << said;
  EXPECT_FALSE(decided("something", automatic).relative);
  EXPECT_TRUE(decided("something", on).relative);
  Settings unknown;
  unknown.surface_velocity = "nothing";
  EXPECT_THROW(decided("velocity", unknown), Error);
}

TEST(RelativeVectors, TheMotionOfTheSurfaceIsTakenAway) {
  const auto position = [](const Vec3d& p, double t) { return p * (1 + 0.2 * t * t) + Vec3d(t, 0, 0); };
  SurfaceSeries series = examine_motion(moving_series(20, [&](double t) { return moved(icosphere(2), t, position); }),
                                        [](const std::string&) {});
  PreparedSurface surface = prepare(series.load(0));
  MotionChoice motion;
  motion.relative = true;
  VectorsInTime input(series, surface, "velocity", "none", nullptr, motion);
  std::vector<Vec3f> v(surface.points.size());
  for (const double t : {0.3, 0.325, 0.7}) {
    input.vectors(t, v);
    for (const Vec3f& each : v) ASSERT_LT(length(each), 0.01f) << "exact for a parabola at a step";
  }
}

TEST(VectorsInMotion, ColoursHaveTheRangeOfAllSteps) {
  SurfaceSeries series = examine_motion(moving_series(4,
                                                      [&](double t) {
                                                        Surface s = moved(icosphere(2), t, still);
                                                        std::vector<float> values(s.points.size(), float(8 * t));
                                                        s.arrays.push_back({"number", 1, std::move(values)});
                                                        return s;
                                                      }),
                                        [](const std::string&) {});
  const VectorsInTime input(series, prepare(series.load(0)), "velocity", "number");
  EXPECT_EQ(input.color_spread().low, 0);
  EXPECT_EQ(input.color_spread().high, 8);
}

TEST(Period, TimeComesRoundWithoutAJump) {
  SurfaceSeries series = examine_motion(moving_series(9,
                                                      [](double t) {
                                                        return moved(icosphere(1), t, [](const Vec3d& p, double u) {
                                                          return p * (2 + std::sin(2 * std::numbers::pi * 0.9 * u));
                                                        });
                                                      }),
                                        [](const std::string&) {});
  PreparedSurface surface = prepare(series.load(0));
  MotionChoice motion;
  motion.period = 1 / 0.9;  // ten steps of 1/9
  motion.relative = true;
  VectorsInTime input(series, surface, "velocity", "speed", nullptr, motion);
  EXPECT_DOUBLE_EQ(input.end(), 1 / 0.9);
  std::vector<Vec3f> a(surface.points.size()), b = a;
  for (const double t : {0.0, 0.25, 1.05, 1.1}) {
    EXPECT_LT(length(input.points(t)[3] - input.points(t + motion.period)[3]), 1e-6) << t;
    input.vectors(t, a);
    input.vectors(t + motion.period, b);
    EXPECT_LT(length(a[3] - b[3]), 1e-4f) << t;
    EXPECT_LT(length(a[3]), 0.6f) << "6.2 without what the surface does";
  }
  const double eps = 1e-4;
  EXPECT_LT(length(input.points(motion.period - eps)[3] - input.points(eps)[3]), 2e-3);
  const Vec3d middle = (input.points(1.0)[3] + input.points(0.0)[3]) * 0.5;
  EXPECT_LT(length(input.points(1 + 0.5 / 9)[3] - middle), 1e-9) << "between the last step and the first";
  motion.period = 0.5;
  EXPECT_THROW(VectorsInTime(series, surface, "velocity", "none", nullptr, motion), Error);
}

}  // namespace
}  // namespace nacre::test
