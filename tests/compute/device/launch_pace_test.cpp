// Nacre: launches in parts are as long as they may be.
#include "compute/device/launch_pace.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace nacre {
namespace {

struct Parts {
  int count = 0;
  double seconds = 0, longest = 0;
};

/// All of `n` elements in measured parts, on a device that runs `wide` elements at once; element i takes seconds(i).
Parts run(LaunchPace& pace, std::int64_t n, const std::function<double(std::int64_t)>& seconds, double wide = 65536) {
  Parts parts;
  for (std::int64_t first = 0; first < n;) {
    const std::int64_t count = std::min(pace.careful_part(), n - first);
    const double took = 5e-6 + seconds(first + count / 2) * std::max(1.0, double(count) / wide);
    pace.note(count, float(took));
    parts.seconds += took, parts.longest = std::max(parts.longest, took);
    ++parts.count, first += count;
  }
  return parts;
}

TEST(LaunchPace, LongLaunchesStayBelowTheLimitAndShortOnesWhole) {
  for (const double each : {1e-7, 1e-5, 1e-3}) {
    LaunchPace pace;
    const std::int64_t n = 100'000'000;
    const Parts first = run(pace, n, [&](std::int64_t) { return each; });
    EXPECT_LT(first.longest, LaunchPace::most_seconds) << each;
    const Parts next = run(pace, n, [&](std::int64_t) { return each; });
    EXPECT_LT(next.longest, LaunchPace::most_seconds) << each;
    EXPECT_LE(next.count, 1 + next.seconds / (0.2 * LaunchPace::most_seconds)) << each << ": no more than need be";
    if (each < 1e-4) {
      EXPECT_EQ(next.count, 1) << each;
    }
  }
}

TEST(LaunchPace, ElementsThatBecomeSlowerAreNotTriedManyAtOnce) {
  LaunchPace pace;
  const std::int64_t n = 100'000'000;
  const Parts parts = run(pace, n, [&](std::int64_t i) { return 1e-4 * (1 + 20 * double(i) / double(n)); });
  EXPECT_LT(parts.longest, LaunchPace::most_seconds);
}

TEST(LaunchPace, ALaunchOfOneElementSaysLittleAboutManyOfThem) {
  LaunchPace pace;
  pace.note(1, 5e-6f);
  EXPECT_GE(pace.part(), LaunchPace::least_part);
  EXPECT_TRUE(pace.is_short(1));
  EXPECT_FALSE(pace.is_short(2)) << "not tried";
}

TEST(LaunchPace, AnElementThatIsSlowByItselfIsStillLaunched) {
  LaunchPace pace;
  pace.note(1, 1e6f);
  EXPECT_EQ(pace.part(), 1);
  for (int k = 0; k < 100; ++k) pace.note(1, 1e-6f);
  EXPECT_GE(pace.part(), LaunchPace::least_part) << "and forgotten";
}

}  // namespace
}  // namespace nacre
