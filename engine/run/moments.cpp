// Nacre: times of the data between two.
#include "engine/run/moments.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {

std::vector<double> moments(const VectorsInTime& input, double from, double duration, int intervals) {
  const double low = std::min(from, from + duration), high = std::max(from, from + duration);
  const bool analytic = input.array().starts_with('@');
  if (analytic) intervals = std::max(intervals, int(std::ceil(64 * std::min(1e4, high - low))));
  std::vector<double> times;
  for (int k = 0; k <= intervals; ++k) times.push_back(low + (high - low) * k / intervals);
  const double period = input.motion().period, first = input.series().times.front();
  const double cycles = period > 0 ? std::floor((low - first) / period) : 0;
  for (double shift = cycles * period; shift <= high - first; shift += period) {
    for (const double t : input.series().times)
      if (t + shift > low && t + shift < high) times.push_back(t + shift);
    if (!(period > 0)) break;
  }
  std::sort(times.begin(), times.end());
  const double least = 1e-9 * (high - low);
  times.erase(std::unique(times.begin(), times.end(), [&](double a, double b) { return b - a < least; }), times.end());
  times.back() = high;
  if (duration < 0) std::reverse(times.begin(), times.end());
  return times;
}

}  // namespace nacre
