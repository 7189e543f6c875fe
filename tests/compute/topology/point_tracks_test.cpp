// Nacre: critical points followed in time, on fields whose points move as is known.
#include "compute/topology/point_tracks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compute/device/error.hpp"
#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

PointsAt on(const Shape& shape, const std::function<Vec3d(const Vec3d&, double)>& field) {
  return [&shape, field](double t) {
    const std::vector<Vec3f> vectors = vectors_on(shape, [&](const Vec3d& p) { return field(p, t); });
    return find_critical_points(TangentField(shape.points, shape.triangles, vectors), 0).points;
  };
}

Vec3d turned_about_z(const Vec3d& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

/// The gradient of x^2 + 2 y^2 + 3 z^2, turned about the z axis by t.
Vec3d turning_gradient(const Vec3d& p, double t) {
  const Vec3d q = turned_about_z(p, -t);
  return turned_about_z(Vec3d(2 * q.x, 4 * q.y, 6 * q.z), t);
}

TEST(PointTracks, PointsThatTurnAreFollowedAlsoInWideSteps) {
  const Shape sphere = divided_sphere(4);
  for (const double step : {0.1, 1.2}) {  // at 1.2 the nearest is no longer clearly the nearest
    std::vector<double> times;
    for (int k = 0; k < 8; ++k) times.push_back(k * step);
    const std::vector<PointTrack> tracks = track_points(on(sphere, turning_gradient), times);
    ASSERT_EQ(tracks.size(), 6u) << step;
    for (const PointTrack& track : tracks) {
      ASSERT_EQ(track.points.size(), times.size()) << step;
      for (std::size_t k = 0; k < times.size(); ++k) {
        EXPECT_EQ(track.points[k].kind, track.points[0].kind);
        EXPECT_LT(length(track.points[k].position - turned_about_z(track.points[0].position, times[k])), 0.03);
      }
    }
  }
}

/// At first none; at t = 0.35 a source and a saddle appear at (0, 0), and part.
TEST(PointTracks, APairThatAppearsBeginsTwoTracks) {
  const Shape plate = square(40);
  const auto field = [](const Vec3d& p, double t) { return Vec3d(p.x * p.x - 0.1 * (t - 0.35), p.y, 0); };
  std::vector<double> times;
  for (int k = 0; k <= 10; ++k) times.push_back(0.1 * k);
  const std::vector<PointTrack> tracks = track_points(on(plate, field), times);
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].points[0].index + tracks[1].points[0].index, 0);
  for (const PointTrack& track : tracks) {
    EXPECT_EQ(track.first, 4u);
    ASSERT_EQ(track.points.size(), 7u);
    EXPECT_NEAR(std::fabs(track.points.back().position.x), std::sqrt(0.1 * 0.65), 0.02);
  }
}

TEST(PointTracks, WhatVanishesEndsAndASteadyFieldIsCheap) {
  const Shape sphere = divided_sphere(3);
  int asked = 0;
  const PointsAt exact = on(sphere, [](const Vec3d& p, double) { return turning_gradient(p, 0); });
  const PointsAt counted = [&](double t) {
    ++asked;
    std::vector<CriticalPoint> points = exact(t);
    if (t > 2.5) points.erase(points.begin());
    return points;
  };
  const std::vector<double> times{0, 1, 2, 3, 4};
  const std::vector<PointTrack> tracks = track_points(counted, times);
  ASSERT_EQ(tracks.size(), 6u);
  EXPECT_EQ(tracks[0].points.size(), 3u);
  for (std::size_t k = 1; k < 6; ++k) EXPECT_EQ(tracks[k].points.size(), 5u);
  EXPECT_LE(asked, 5 + 7) << "only the interval in which something happens is halved";
  std::atomic<bool> stop{true};
  EXPECT_THROW(track_points(counted, times, &stop), Interrupted);
}

}  // namespace
}  // namespace nacre::test
