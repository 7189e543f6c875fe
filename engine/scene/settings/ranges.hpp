// Nacre: parses ranges such as "0:2" and "2%:98%", for the time and the colours of a flow.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "compute/device/ranks.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

struct Range {
  double low = 0, high = 0;
};

/// "A<separator>B", two finite numbers. Throws Error that names `option`.
std::pair<double, double> parse_pair(const std::string& text, char separator, const std::string& option);

/// The knob `time`, which is not empty. Throws Error where it is no range or ends before it starts.
Range parse_time_range(const Settings& settings);
/// Which values a colour map meets, at all times.
struct ColourSpread {
  double low = 0, high = 1;   ///< the range without a wish; of a speed from 0 to what is usual
  double least_positive = 0;  ///< of the values sampled; 0: none is above 0
  bool gaps = false;          ///< some are no numbers
  std::vector<float> sample;  ///< finite values, sorted: a part of all, of every time

  /// Below this are so many percent of the sample, linearly interpolated; `low` or `high` where there is no sample.
  double percentile(double percent) const;
};

/// Collects a spread.
class ColourSurvey {
 public:
  /// All values count for the ends, those `sampled` for percentiles, too.
  void add(float value, bool sampled);
  /// Takes up what other processes have collected. Collective.
  void join(Ranks& ranks);
  /// With ends 0 and 1 where there was no number, and an end above the other where all are the same.
  ColourSpread spread() &&;

 private:
  double low_ = 1e300, high_ = -1e300;
  ColourSpread spread_;
};

/// What a colour map spans, and how.
struct ColourRange {
  double low = 0, high = 1;
  bool log = false;  ///< equal ratios are equal distances on the map; both ends are above 0

  /// On a scale that is linear on the map: the value, or its logarithm. What has no logarithm lies below the low end.
  float on_axis(float value) const;
  double bottom() const { return log ? on_axis(float(low)) : low; }
  double top() const { return log ? on_axis(float(high)) : high; }
  /// `on_axis` of each; as they are where it is not logarithmic.
  std::vector<float> on_axis(std::vector<float> values) const;
};

/// Throws Error where the knobs `color_range`, `color_scale` and `color_symmetric` contradict themselves or each other.
void check_color_range(const Settings& settings);

/// By these knobs: numbers LOW:HIGH, percentiles A%:B%, or the spread's own ends; as far below 0 as above; on a
/// logarithmic scale from the least positive value where it would begin at 0 or below. Throws Error like
/// `check_color_range`, and where a logarithmic scale has nothing above 0.
ColourRange color_range(const Settings& settings, const ColourSpread& of_data);

/// What a run goes over.
struct FlowSpan {
  double start = 0, end = 0;  ///< time of the data at the first frame's step and after the last
  double first = 0;           ///< where it starts over when it has come round: the start, less what `begin_at` skips
  int steps = 0;              ///< from start to end
  double frame_time = 0;      ///< of the data, from frame to frame
};

/// The steps of a run: the knob `steps`, less those that `begin_at` skips.
int remaining_steps(const Settings& settings);

/// By the knobs `time`, `begin_at` and `steps`, for data over `of_data`. The frames of a run that begins later are
/// frames of the whole one. Throws Error where `time` is off or outside of the data.
FlowSpan flow_span(const Settings& settings, const Range& of_data);

}  // namespace nacre
