// Nacre: pairs of numbers in words, and what they mean for a flow: its time, its colours.
#pragma once

#include <string>
#include <utility>

#include "engine/scene/settings/settings.hpp"

namespace nacre {

struct Range {
  double low = 0, high = 0;
};

/// "A<separator>B", two finite numbers. Throws Error that names `option`.
std::pair<double, double> parse_pair(const std::string& text, char separator, const std::string& option);

/// The knob `time`, which is not empty. Throws Error where it is no range or ends before it starts.
Range parse_time_range(const Settings& settings);
/// The knob `color_range`, which is not empty. Throws Error where it is no range or holds nothing.
Range parse_color_range(const Settings& settings);

/// What the colour map spans: what the knob `color_range` says, else `of_data`. Throws Error like `parse_color_range`.
Range color_range(const Settings& settings, const Range& of_data);

/// What a run goes over.
struct FlowSpan {
  double start = 0, end = 0;  ///< time of the data at the first frame's step and after the last
  double first = 0;           ///< where it begins anew when it has come round: the start, less what `begin_at` skips
  int steps = 0;              ///< from start to end
  double frame_time = 0;      ///< of the data, from frame to frame
};

/// By the knobs `time`, `begin_at` and `steps`, for data over `of_data`. The frames of a run that begins later are
/// frames of the whole one. Throws Error where `time` is off or outside of the data.
FlowSpan flow_span(const Settings& settings, const Range& of_data);

}  // namespace nacre
