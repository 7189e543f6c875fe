// Nacre: critical points followed in time.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/topology/critical_points.hpp"

namespace nacre {

/// A critical point at consecutive times.
struct PointTrack {
  std::size_t first = 0;              ///< number of the first time at which it is there
  std::vector<CriticalPoint> points;  ///< one for each time from then on
};

/// The critical points at a time.
using PointsAt = std::function<std::vector<CriticalPoint>(double time)>;

/// Follows the points through `times` (ascending). Two of one index at neighbouring times are the same if each is the
/// other's nearest, and clearly: less than a third as far as any other. Where that leaves points over, the interval is
/// halved, up to three times, so that fast points are followed and crossing ones are told apart. What is still left
/// over has appeared or vanished, as saddles and points of index 1 do in pairs. In the order of `first`. Throws
/// Interrupted where `stop` is set.
std::vector<PointTrack> track_points(const PointsAt& points_at, std::span<const double> times,
                                     const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
