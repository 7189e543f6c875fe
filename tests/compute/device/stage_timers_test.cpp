// Nacre: how long each stage took.
#include "compute/device/stage_timers.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

TEST(StageTimers, StagesAreListedInTheOrderInWhichTheyEnd) {
  StageTimers timers;
  for (int k = 0; k < 2; ++k) {
    StageTimers::Scope outer(timers, "outer");
    StageTimers::Scope inner(timers, "inner");
    timers.count_launch();
  }
  ASSERT_EQ(timers.stages().size(), 2u);
  EXPECT_EQ(timers.stages()[0].name, "inner");
  EXPECT_EQ(timers.stages()[1].name, "outer");
  EXPECT_EQ(timers.stages()[1].calls, 2);
  EXPECT_EQ(timers.stages()[1].launches, 2);
  EXPECT_GE(timers.seconds("outer"), timers.seconds("inner"));
}

/// A stage may end because there is no memory: then its end must not ask for more.
TEST(StageTimers, TheListHasRoomForEveryStageThatIsOpen) {
  StageTimers timers;
  const StageTimers::Stage* list = nullptr;
  {
    StageTimers::Scope outer(timers, "a stage with a name too long for a short string");
    StageTimers::Scope middle(timers, "a second stage with such a name, as long as that");
    { StageTimers::Scope inner(timers, "and a third one, with a name that is longer still"); }
    list = timers.stages().data();
  }
  EXPECT_EQ(timers.stages().size(), 3u);
  EXPECT_EQ(timers.stages().data(), list);
}

}  // namespace
}  // namespace nacre
