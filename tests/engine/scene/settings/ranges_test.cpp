// Nacre: ranges in words.
#include "engine/scene/settings/ranges.hpp"

#include <gtest/gtest.h>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

TEST(Ranges, ColoursAreTheDatasUnlessTheKnobSaysElse) {
  Settings settings;
  EXPECT_EQ(color_range(settings, {2, 5}).high, 5);
  settings.color_range = "-1:2.5";
  EXPECT_EQ(color_range(settings, {2, 5}).low, -1);
  EXPECT_EQ(color_range(settings, {2, 5}).high, 2.5);
  for (const char* nonsense : {"1", "2:1", "1:1", "a:b", "1:nan", "0:inf", "1:2:3", ":", "1:"}) {
    settings.color_range = nonsense;
    EXPECT_THROW(color_range(settings, {2, 5}), Error) << nonsense;
  }
}

TEST(Ranges, ASpanIsAllOfTheDataOrPartOfIt) {
  Settings settings;
  settings.flow.steps = 8;
  FlowSpan span = flow_span(settings, {1, 5});
  EXPECT_EQ(span.start, 1);
  EXPECT_EQ(span.end, 5);
  EXPECT_EQ(span.steps, 8);
  EXPECT_EQ(span.frame_time, 0.5);
  settings.time = "2:4";
  span = flow_span(settings, {1, 5});
  EXPECT_EQ(span.start, 2);
  EXPECT_EQ(span.end, 4);
  EXPECT_EQ(span.steps, 8);
  settings.time = "7:8";
  EXPECT_THROW(flow_span(settings, {1, 5}), Error);
  settings.time = "4:2";
  EXPECT_THROW(flow_span(settings, {1, 5}), Error);
}

TEST(Ranges, ALaterBeginningIsOnAFrameOfTheWhole) {
  Settings settings;
  settings.flow.steps = 8;
  settings.begin_at = 0.3;  // nearest to the second of eight frames
  const FlowSpan span = flow_span(settings, {1, 5});
  EXPECT_EQ(span.first, 1);
  EXPECT_EQ(span.start, 2);
  EXPECT_EQ(span.end, 5);
  EXPECT_EQ(span.steps, 6);
  EXPECT_EQ(span.frame_time, 0.5);
  settings.begin_at = 1;
  EXPECT_EQ(flow_span(settings, {1, 5}).steps, 0);
  EXPECT_EQ(flow_span(settings, {1, 5}).start, 5);
  settings.flow.steps = 0;
  EXPECT_EQ(flow_span(settings, {1, 5}).start, 1);
}

}  // namespace
}  // namespace nacre
