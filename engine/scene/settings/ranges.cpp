// Nacre: pairs of numbers in words, and what they mean for a flow.
#include "engine/scene/settings/ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compute/device/error.hpp"

namespace nacre {

std::pair<double, double> parse_pair(const std::string& text, char separator, const std::string& option) {
  const auto at = text.find(separator);
  try {
    std::size_t used_first = 0, used_second = 0;
    const double first = std::stod(text, &used_first), second = std::stod(text.substr(at + 1), &used_second);
    const bool whole = at != std::string::npos && used_first == at && used_second == text.size() - at - 1;
    if (whole && std::isfinite(first) && std::isfinite(second)) return {first, second};
  } catch (const std::logic_error&) {
  }
  throw Error(fmt::format("{} takes A{}B, not '{}'", option, separator, text));
}

Range parse_time_range(const Settings& settings) {
  const auto [low, high] = parse_pair(settings.time, ':', "--time");
  if (high < low) throw Error("--time ends before it starts");
  return {low, high};
}

Range parse_color_range(const Settings& settings) {
  const auto [low, high] = parse_pair(settings.color_range, ':', "--color-range");
  if (!(low < high)) throw Error("--color-range " + settings.color_range + " is empty", "", "write LOW:HIGH");
  return {low, high};
}

Range color_range(const Settings& settings, const Range& of_data) {
  return settings.color_range.empty() ? of_data : parse_color_range(settings);
}

FlowSpan flow_span(const Settings& settings, const Range& of_data) {
  Range all = of_data;
  if (!settings.time.empty()) {
    all = parse_time_range(settings);
    if (all.low > of_data.high || all.high < of_data.low)
      throw Error(fmt::format("--time {} is outside of the data", settings.time), "",
                  fmt::format("use {:g}:{:g}", of_data.low, of_data.high));
  }
  const int steps = settings.flow.steps;
  const int skipped = std::clamp(int(std::lround(settings.begin_at * steps)), 0, steps);
  FlowSpan span;
  span.frame_time = (all.high - all.low) / std::max(1, steps);
  span.first = all.low;
  span.start = skipped == 0 ? all.low : all.low + (all.high - all.low) * (double(skipped) / steps);
  span.end = all.high;
  span.steps = steps - skipped;
  return span;
}

}  // namespace nacre
