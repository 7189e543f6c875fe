// Nacre: tests of the scenes that are kept for undo.
#include "app/viewer/window/left_scenes.hpp"

#include <gtest/gtest.h>

#include "tests/app/viewer/still_scene.hpp"

namespace nacre {
namespace {

test::StillScene* keep(LeftScenes& left, const std::string& sample, std::size_t bytes = 0) {
  auto scene = std::make_unique<test::StillScene>(Vec3d(0, 0, 0), Vec3d(1, 1, 1));
  scene->bytes = bytes;
  test::StillScene* const kept = scene.get();
  Session session;
  session.sample = sample;
  left.keep({std::move(scene), nullptr}, session);
  return kept;
}

SessionInput sample(const std::string& name) { return {{}, name, 0}; }

TEST(LeftScenes, TheLastTwoAreThereAndStandStill) {
  LeftScenes left;
  keep(left, "a");
  const test::StillScene* b = keep(left, "b");
  EXPECT_EQ(b->cancels, 1);
  keep(left, "c");
  EXPECT_FALSE(left.take(sample("a")));
  const auto again = left.take(sample("b"));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->open.scene.get(), b);
  EXPECT_FALSE(left.take(sample("b"))) << "it is in use";
  EXPECT_TRUE(left.take(sample("c")));
}

TEST(LeftScenes, WhatNeedsTooMuchMemoryIsNotKept) {
  LeftScenes left;
  keep(left, "a");
  keep(left, "b", std::size_t(3) << 30);
  EXPECT_FALSE(left.take(sample("b")));
  keep(left, "c", std::size_t(1) << 30);
  EXPECT_TRUE(left.take(sample("c")));
}

TEST(LeftScenes, WhatFailedIsNotKept) {
  LeftScenes left;
  auto scene = std::make_unique<test::StillScene>(Vec3d(0, 0, 0), Vec3d(1, 1, 1));
  scene->what_failed = "no vectors";
  left.keep({std::move(scene), nullptr}, Session());
  EXPECT_FALSE(left.take(SessionInput()));
}

}  // namespace
}  // namespace nacre
