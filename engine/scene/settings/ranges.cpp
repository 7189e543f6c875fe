// Nacre: parses ranges such as "0:2" and "2%:98%".
#include "engine/scene/settings/ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compute/device/among_all.hpp"
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

namespace {

/// What the knob `color_range` says; it is not empty.
struct WantedRange {
  double low, high;
  bool percentiles;
};

WantedRange parse_color_range(const std::string& text) {
  std::string numbers = text;
  const auto colon = numbers.find(':');
  const bool percentiles =
      colon != std::string::npos && colon > 0 && numbers.ends_with('%') && numbers[colon - 1] == '%';
  if (percentiles) numbers = numbers.substr(0, colon - 1) + ":" + numbers.substr(colon + 1, numbers.size() - colon - 2);
  const auto [low, high] = parse_pair(numbers, ':', "--color-range");
  if (!(low < high)) throw Error("--color-range " + text + " is empty", "", "write LOW:HIGH");
  if (percentiles && (low < 0 || high > 100))
    throw Error("--color-range " + text + " goes beyond all values", "", "write percentiles from 0% to 100%");
  return {low, high, percentiles};
}

}  // namespace

double ColourSpread::percentile(double percent) const {
  if (sample.empty()) return low + (high - low) * percent / 100;
  const double at = percent / 100 * double(sample.size() - 1);
  const auto before = std::min(std::size_t(at), sample.size() - 1), after = std::min(before + 1, sample.size() - 1);
  return sample[before] + (at - double(before)) * (double(sample[after]) - sample[before]);
}

void ColourSurvey::add(float value, bool sampled) {
  if (!std::isfinite(value)) {
    spread_.gaps = spread_.gaps || std::isnan(value);
    return;
  }
  low_ = std::min(low_, double(value));
  high_ = std::max(high_, double(value));
  if (value > 0 && (spread_.least_positive == 0 || value < spread_.least_positive)) spread_.least_positive = value;
  if (sampled) spread_.sample.push_back(value);
}

void ColourSurvey::join(Ranks& ranks) {
  constexpr double no_positive = 1e300;
  double positive = spread_.least_positive > 0 ? spread_.least_positive : no_positive, gaps = spread_.gaps ? 1 : 0;
  double least[] = {low_, positive}, largest[] = {high_, gaps};
  extremes_of_all(&ranks, least, largest);
  low_ = least[0], high_ = largest[0];
  spread_.least_positive = least[1] < no_positive ? least[1] : 0;
  spread_.gaps = largest[1] > 0;
  ForEachRank<float> send(static_cast<std::size_t>(ranks.count()), spread_.sample);
  spread_.sample.clear();
  for (const std::vector<float>& from : exchange_items(ranks, send))
    spread_.sample.insert(spread_.sample.end(), from.begin(), from.end());
}

ColourSpread ColourSurvey::spread() && {
  std::sort(spread_.sample.begin(), spread_.sample.end());
  if (low_ <= high_) {
    spread_.low = low_;
    spread_.high = high_ > low_ ? high_ : low_ + 1;
  }
  return std::move(spread_);
}

float ColourRange::on_axis(float value) const {
  if (!log || std::isnan(value)) return value;
  const double first = std::log10(low), last = std::log10(high);
  return float(value > 0 ? std::log10(double(value)) : 2 * first - last);
}

std::vector<float> ColourRange::on_axis(std::vector<float> values) const {
  if (log)
    for (float& value : values) value = on_axis(value);
  return values;
}

void check_color_range(const Settings& settings) {
  const bool log = settings.color_scale == ColourScale::log;
  if (log && settings.color_symmetric)
    throw Error("--color-symmetric and --color-scale log exclude each other", "a logarithm has no values below 0",
                "leave one of them out");
  if (settings.color_range.empty()) return;
  const WantedRange wanted = parse_color_range(settings.color_range);
  if (log && !wanted.percentiles && wanted.high <= 0)
    throw Error("--color-range " + settings.color_range + " has no logarithm", "it lies at 0 or below",
                "give values above 0, or --color-scale linear");
}

ColourRange color_range(const Settings& settings, const ColourSpread& of_data) {
  check_color_range(settings);
  ColourRange range{of_data.low, of_data.high, settings.color_scale == ColourScale::log};
  if (!settings.color_range.empty()) {
    const WantedRange wanted = parse_color_range(settings.color_range);
    range.low = wanted.percentiles ? of_data.percentile(wanted.low) : wanted.low;
    range.high = wanted.percentiles ? of_data.percentile(wanted.high) : wanted.high;
  }
  if (settings.color_symmetric) {
    range.high = std::max(std::abs(range.low), std::abs(range.high));
    range.low = -range.high;
  }
  if (range.log && !(range.low > 0)) range.low = of_data.least_positive;
  if (range.log && !(range.low > 0 && range.high > 0))
    throw Error("a logarithmic colour scale has nothing to show", "no value is above 0", "use --color-scale linear");
  if (!(range.low < range.high)) range.high = range.log ? 10 * range.low : range.low + 1;
  return range;
}

int remaining_steps(const Settings& settings) {
  const int steps = settings.flow.steps;
  return steps - std::clamp(int(std::lround(settings.begin_at * steps)), 0, steps);
}

FlowSpan flow_span(const Settings& settings, const Range& of_data) {
  Range all = of_data;
  if (!settings.time.empty()) {
    all = parse_time_range(settings);
    if (all.low > of_data.high || all.high < of_data.low)
      throw Error(fmt::format("--time {} is outside of the data", settings.time), "",
                  fmt::format("use {:g}:{:g}", of_data.low, of_data.high));
  }
  const int steps = settings.flow.steps, skipped = steps - remaining_steps(settings);
  FlowSpan span;
  span.frame_time = (all.high - all.low) / std::max(1, steps);
  span.first = all.low;
  span.start = skipped == 0 ? all.low : all.low + (all.high - all.low) * (double(skipped) / steps);
  span.end = all.high;
  span.steps = steps - skipped;
  return span;
}

}  // namespace nacre
