// Nacre: what the mouse does to a camera.
#include "engine/render/camera_motion.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

Camera front_camera() {
  Camera camera;
  camera.eye = {0, -10, 0};
  camera.target = {0, 0, 0};
  camera.up = {0, 0, 1};
  camera.height = 4;
  return camera;
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
  EXPECT_LE(length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " / " << b.x << " " << b.y << " " << b.z;
}

/// Where on the picture a point is: the inverse of the projection that all pictures use.
std::array<double, 2> place_of(const Camera& c, const Vec3d& p, double aspect) {
  const Vec3d right = c.right(), up = cross(right, c.forward()), d = p - c.eye;
  const double scale = length(c.target - c.eye) / dot(d, c.forward()) / (0.5 * c.height);
  return {dot(d, right) * scale / aspect, dot(d, up) * scale};
}

TEST(CameraMotion, PointUnderTheCursorIsInThePlaneOfTheTarget) {
  expect_near(point_under(front_camera(), 0, 0, 1.5), {0, 0, 0});
  expect_near(point_under(front_camera(), 1, 0, 1.5), {3, 0, 0});
  expect_near(point_under(front_camera(), 0, -1, 1.5), {0, 0, -2});
}

TEST(CameraMotion, TurningKeepsTheDistanceAndTheTarget) {
  for (const Camera& c : {turn_table(front_camera(), 0.3, 0.4), turn_ball(front_camera(), 0.3, 0.4)}) {
    EXPECT_NEAR(length(c.eye - c.target), 10, 1e-12);
    expect_near(c.target, {0, 0, 0});
  }
}

TEST(CameraMotion, AcrossTheWholePictureIsHalfACircle) {
  expect_near(turn_table(front_camera(), 2, 0).eye, {0, 10, 0});
  expect_near(turn_table(front_camera(), 1, 0).eye, {-10, 0, 0});  // the scene follows the hand to the right
  expect_near(turn_ball(front_camera(), 0, 1).eye, {0, 0, -10}, 1e-12);
}

TEST(CameraMotion, DownLiftsTheEyeForBoth) {
  EXPECT_GT(turn_table(front_camera(), 0, -0.2).eye.z, 0);
  EXPECT_GT(turn_ball(front_camera(), 0, -0.2).eye.z, 0);
  expect_near(turn_table(front_camera(), 0, -0.2).eye, turn_ball(front_camera(), 0, -0.2).eye, 1e-12);
}

TEST(CameraMotion, TurntableStopsShortOfThePole) {
  Camera c = front_camera();
  for (int k = 0; k < 50; ++k) c = turn_table(c, 0, -0.1);
  EXPECT_NEAR(c.eye.z, 10 * std::cos(3.14159265358979 / 180), 1e-9);
  expect_near(c.up, {0, 0, 1});
  EXPECT_GT(dot(c.right(), Vec3d(1, 0, 0)), 0.999);  // nothing has flipped
  for (int k = 0; k < 100; ++k) c = turn_table(c, 0, 0.1);
  EXPECT_LT(c.eye.z, -9.9);
}

TEST(CameraMotion, TrackballGoesOverThePole) {
  Camera c = front_camera();
  for (int k = 0; k < 10; ++k) c = turn_ball(c, 0, -0.2);
  expect_near(c.eye, {0, 10, 0}, 1e-9);
  expect_near(c.up, {0, 0, -1}, 1e-9);
}

TEST(CameraMotion, PanMovesTheSceneWithTheHand) {
  const Vec3d p = point_under(front_camera(), 0.25, -0.5, 1.5);
  const Camera c = pan(front_camera(), 0.1, 0.2, 1.5);
  const auto at = place_of(c, p, 1.5);
  EXPECT_NEAR(at[0], 0.35, 1e-12);
  EXPECT_NEAR(at[1], -0.3, 1e-12);
}

TEST(CameraMotion, DollyKeepsWhatIsUnderTheCursor) {
  const Vec3d p = point_under(front_camera(), 0.6, 0.3, 1.5);
  for (const double factor : {0.5, 2.0}) {
    const Camera c = dolly(front_camera(), factor, 0.6, 0.3, 1.5);
    const auto at = place_of(c, p, 1.5);
    EXPECT_NEAR(at[0], 0.6, 1e-12);
    EXPECT_NEAR(at[1], 0.3, 1e-12);
    EXPECT_NEAR(c.height, 4 * factor, 1e-12);
  }
}

TEST(CameraMotion, ADeeperTargetShowsTheSamePicture) {
  for (const Vec3d p : {Vec3d(0.3, 0.4, 0.5), Vec3d(-1, 0.2, -2)}) {
    const Camera camera = front_camera(), c = look_at_depth(camera, camera.target + p);
    EXPECT_NEAR(dot(camera.target + p - c.target, c.forward()), 0, 1e-12);
    for (const Vec3d q : {p, Vec3d(1, 1, 1), Vec3d(0, -1, 0.2)})
      for (const std::size_t k : {0, 1})
        EXPECT_NEAR(place_of(c, camera.target + q, 1.5)[k], place_of(camera, camera.target + q, 1.5)[k], 1e-12);
  }
  Camera flat = front_camera();
  flat.orthographic = true;
  const Camera c = look_at_depth(flat, flat.target + Vec3d(0.3, 0.4, 0.5));
  EXPECT_EQ(c.height, flat.height);
  EXPECT_NEAR(length(cross(c.target - flat.target, flat.forward())), 0, 1e-12) << "it moves along its own direction";
  EXPECT_NEAR(length((c.target - c.eye) - (flat.target - flat.eye)), 0, 1e-12);
}

TEST(CameraMotion, ZoomingEndsNearTheSurfaceAndBeforeAllVanishes) {
  const double extent = 3;
  const Vec3d surface = front_camera().target + Vec3d(0.1, 0.2, 0.3);
  for (const double factor : {0.5, 2.0}) {
    Camera camera = front_camera();
    for (int k = 0; k < 100; ++k) {
      camera = look_at_depth(camera, surface);
      camera = dolly(camera, limited_zoom(camera, factor, extent), 0, 0, 1.5);
      ASSERT_GT(dot(surface - camera.eye, camera.forward()), 0) << "the eye is still before it";
    }
    EXPECT_NEAR(camera.height, factor < 1 ? 1e-4 * extent : 10 * extent, 1e-9);
  }
  Camera beyond = front_camera();
  beyond.height = 1000;
  EXPECT_EQ(limited_zoom(beyond, 2, extent), 1);
  EXPECT_EQ(limited_zoom(beyond, 0.5, extent), 0.5) << "it may come back";
}

}  // namespace
}  // namespace nacre
