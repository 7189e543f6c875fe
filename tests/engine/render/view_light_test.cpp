// Nacre: the light that knobs turn.
#include <gtest/gtest.h>

#include "engine/render/view.hpp"

namespace nacre {
namespace {

/// Looks along y, z is up.
Camera camera() {
  Camera c;
  c.eye = {0, -5, 0};
  c.up = {0, 0, 1};
  return c;
}

void expect_same_direction(const Vec3d& a, const Vec3d& b) {
  EXPECT_LT(length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(Light, StandsWhereItStoodAtZero) {
  const Vec3d light = flow_light(camera());
  EXPECT_EQ(turned_light(light, camera(), 0, 0), light);
  expect_same_direction(turned_light(light, camera(), 360, 0), light);
}

TEST(Light, TurnsToTheRightAndRises) {
  const Vec3d at_us(0, -1, 0);
  expect_same_direction(turned_light(at_us, camera(), 90, 0), {1, 0, 0});
  expect_same_direction(turned_light(at_us, camera(), -90, 0), {-1, 0, 0});
  expect_same_direction(turned_light(at_us, camera(), 180, 0), {0, 1, 0});
  expect_same_direction(turned_light(at_us, camera(), 0, 90), {0, 0, 1});
  expect_same_direction(turned_light(at_us, camera(), 90, 45), normalized(Vec3d(1, 0, 1)));
}

TEST(Light, GoesNoFartherThanStraightAbove) {
  const Vec3d light = flow_light(camera());
  expect_same_direction(turned_light(light, camera(), 30, 90), {0, 0, 1});
  expect_same_direction(turned_light({0, 0, -1}, camera(), 30, -90), {0, 0, -1});
}

}  // namespace
}  // namespace nacre
