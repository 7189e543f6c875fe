// Nacre: a window is drawn where it has changed, and not else.

#include "app/viewer/window/draw_demand.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

/// A loop that looks every hundredth of a second; a frame takes half of that.
struct Loop {
  DrawDemand demand;
  DrawDemand::Shown shown{{800, 600}, 1, "", ""};
  double now = 0;

  int frames(int looks, bool touched = false, bool animates = false) {
    int drawn = 0;
    for (int k = 0; k < looks; ++k, now += 0.01) {
      if (!demand.due(now, shown, touched, animates)) continue;
      demand.drawn(now, now + 0.005, shown);
      ++drawn;
    }
    return drawn;
  }
};

TEST(DrawDemand, NothingIsDrawnWhereNothingChanges) {
  Loop loop;
  EXPECT_GT(loop.frames(10), 0) << "the first frames";
  EXPECT_EQ(loop.frames(1000), 0);
}

TEST(DrawDemand, WhatChangesIsDrawnAndSettles) {
  Loop loop;
  loop.frames(10);
  ++loop.shown.scene;
  EXPECT_EQ(loop.frames(100), 3);
  loop.shown.pixels = {640, 480};
  EXPECT_EQ(loop.frames(100), 3);
  loop.shown.progress = "relax 1";
  EXPECT_GT(loop.frames(100), 0);
}

TEST(DrawDemand, AHandOnTheMouseIsAnsweredInEveryFrame) {
  Loop loop;
  loop.shown.progress = "relax 1";
  EXPECT_EQ(loop.frames(100, true), 100);
}

TEST(DrawDemand, WhileItComputesDrawingTakesATenthOfTheTime) {
  Loop loop;
  loop.shown.progress = "relax";
  int drawn = 0;
  for (int k = 0; k < 1000; ++k) {
    ++loop.shown.scene;
    drawn += loop.frames(1);
  }
  EXPECT_LE(drawn * 0.005, 0.11 * 1000 * 0.01);
  EXPECT_GT(drawn, 150);
}

TEST(DrawDemand, WhatMovesWithTimeIsDrawnTenTimesASecond) {
  Loop loop;
  loop.frames(10);
  EXPECT_NEAR(loop.frames(1000, false, true), 100, 15);
}

}  // namespace
}  // namespace nacre
