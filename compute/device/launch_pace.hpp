// Nacre: how many elements of a kernel one launch may have so that it ends in time.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace nacre {

/// Learns from the launches of one kernel how fast it is.
class LaunchPace {
 public:
  static constexpr float most_seconds = 0.2f;  ///< drivers of screens end a kernel after about two seconds
  /// So many take about as long as one: they do not fill a GPU.
  static constexpr std::int64_t least_part = 1 << 14;

  /// Elements of the next launch: for half of the time, since elements differ.
  std::int64_t part() const {
    const float each = seconds_each_;
    return each > 0 ? std::max(std::int64_t(std::min(most_seconds / 2 / each, 1e15f)), std::int64_t(1)) : least_part;
  }
  /// The same for a launch that is measured: in four times as many elements as were tried there may be slower ones.
  std::int64_t careful_part() const { return std::min(part(), std::max(least_part, 4 * tried_)); }

  /// Need a launch of `n` elements not be measured? It is short by far.
  bool is_short(std::int64_t n) const { return n <= tried_ && float(n) * seconds_each_ < most_seconds / 8; }

  /// A launch of `n` elements took so long. The slowest one counts, and is forgotten slowly.
  void note(std::int64_t n, float seconds) {
    const float each = std::max(seconds, 1e-6f) / float(std::max(n, least_part));
    seconds_each_ = std::max(each, 0.7f * seconds_each_);
    tried_ = std::max<std::int64_t>(tried_, n);
  }

 private:
  std::atomic<float> seconds_each_ = 0;  ///< 0: none was measured
  std::atomic<std::int64_t> tried_ = 0;  ///< most elements of a launch so far
};

}  // namespace nacre
