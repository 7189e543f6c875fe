// Nacre: ranges in words.
#include "engine/scene/settings/ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

/// Data that reach from one value to another.
ColourSpread ends(double low, double high) {
  ColourSpread spread;
  spread.low = low;
  spread.high = high;
  return spread;
}

TEST(Ranges, ColoursAreTheDatasUnlessTheKnobSaysElse) {
  Settings settings;
  EXPECT_EQ(color_range(settings, ends(2, 5)).high, 5);
  settings.color_range = "-1:2.5";
  EXPECT_EQ(color_range(settings, ends(2, 5)).low, -1);
  EXPECT_EQ(color_range(settings, ends(2, 5)).high, 2.5);
  for (const char* nonsense : {"1", "2:1", "1:1", "a:b", "1:nan", "0:inf", "1:2:3", ":", "1:"}) {
    settings.color_range = nonsense;
    EXPECT_THROW(color_range(settings, ends(2, 5)), Error) << nonsense;
  }
}

/// Values 0, 1 .. 100, and one that is no number.
ColourSpread hundred() {
  ColourSurvey survey;
  for (int k = 0; k <= 100; ++k) survey.add(float(k), true);
  survey.add(std::nanf(""), true);
  survey.add(INFINITY, true);
  return std::move(survey).spread();
}

TEST(Ranges, ASpreadKnowsItsEndsAndItsGaps) {
  const ColourSpread spread = hundred();
  EXPECT_EQ(spread.low, 0);
  EXPECT_EQ(spread.high, 100);
  EXPECT_EQ(spread.least_positive, 1);
  EXPECT_TRUE(spread.gaps);
  EXPECT_DOUBLE_EQ(spread.percentile(2.5), 2.5);
  const ColourSpread nothing = ColourSurvey().spread();
  EXPECT_LT(nothing.low, nothing.high);
}

TEST(Ranges, ColoursByPercentiles) {
  Settings settings;
  settings.color_range = "2%:98%";
  EXPECT_DOUBLE_EQ(color_range(settings, hundred()).low, 2);
  EXPECT_DOUBLE_EQ(color_range(settings, hundred()).high, 98);
  for (const char* nonsense : {"2:98%", "2%:98", "98%:2%", "-1%:50%", "0%:101%", "%:%"}) {
    settings.color_range = nonsense;
    EXPECT_THROW(check_color_range(settings), Error) << nonsense;
  }
}

TEST(Ranges, SymmetricColoursReachAsFarBelowZero) {
  Settings settings;
  settings.color_symmetric = true;
  EXPECT_EQ(color_range(settings, ends(-2, 5)).low, -5);
  EXPECT_EQ(color_range(settings, ends(-7, 5)).high, 7);
  settings.color_scale = ColourScale::log;
  EXPECT_THROW(check_color_range(settings), Error);
}

TEST(Ranges, ALogarithmicScaleBeginsAboveZero) {
  Settings settings;
  settings.color_scale = ColourScale::log;
  const ColourRange range = color_range(settings, hundred());
  EXPECT_EQ(range.low, 1);
  EXPECT_EQ(range.high, 100);
  EXPECT_NEAR(range.on_axis(10), 0.5 * (range.bottom() + range.top()), 1e-6);
  EXPECT_LT(range.on_axis(0), range.bottom());
  EXPECT_TRUE(std::isfinite(range.on_axis(-3)));
  EXPECT_TRUE(std::isnan(range.on_axis(std::nanf(""))));
  EXPECT_THROW(color_range(settings, ends(-3, -1)), Error) << "nothing is above 0";
  settings.color_range = "-5:-1";
  EXPECT_THROW(check_color_range(settings), Error);
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
