// Nacre: critical points followed in time.
#include "compute/topology/point_tracks.hpp"

#include <limits>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

constexpr int most_halvings = 3;
constexpr double clearly = 1.0 / 3;  // of the distance to the next nearest

using Points = std::vector<CriticalPoint>;
using Partners = std::vector<std::uint32_t>;  ///< of each point: its number at the other time, or none

struct Nearest {
  std::uint32_t point = none;
  double distance = std::numeric_limits<double>::infinity(), next = std::numeric_limits<double>::infinity();
};

std::vector<Nearest> nearest_of(const Points& from, const Points& to) {
  std::vector<Nearest> nearest(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::uint32_t k = 0; k < to.size(); ++k) {
      if (from[i].index != to[k].index) continue;
      const double d = length(from[i].position - to[k].position);
      Nearest& n = nearest[i];
      if (d < n.distance)
        n.next = n.distance, n.distance = d, n.point = k;
      else if (d < n.next)
        n.next = d;
    }
  return nearest;
}

/// The pairs that leave no doubt.
Partners clear_pairs(const Points& from, const Points& to) {
  const std::vector<Nearest> ahead = nearest_of(from, to), back = nearest_of(to, from);
  Partners partners(from.size(), none);
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    const Nearest& n = ahead[i];
    if (n.point == none || back[n.point].point != i) continue;
    if (n.distance < clearly * n.next && n.distance < clearly * back[n.point].next) partners[i] = n.point;
  }
  return partners;
}

bool all_paired(const Partners& partners, std::size_t others) {
  std::size_t paired = 0;
  for (const std::uint32_t partner : partners) paired += partner != none;
  return paired == partners.size() && paired == others;
}

Partners follow(const PointsAt& points_at, double begin, const Points& from, double end, const Points& to, int halvings,
                const std::atomic<bool>* stop) {
  check_stop(stop);
  Partners partners = clear_pairs(from, to);
  if (halvings == 0 || all_paired(partners, to.size())) return partners;
  const double middle = 0.5 * (begin + end);
  const Points between = points_at(middle);
  const Partners first = follow(points_at, begin, from, middle, between, halvings - 1, stop);
  const Partners second = follow(points_at, middle, between, end, to, halvings - 1, stop);
  for (std::size_t i = 0; i < from.size(); ++i) partners[i] = first[i] == none ? none : second[first[i]];
  return partners;
}

}  // namespace

std::vector<PointTrack> track_points(const PointsAt& points_at, std::span<const double> times,
                                     const std::atomic<bool>* stop) {
  std::vector<PointTrack> tracks;
  std::vector<std::size_t> track_of;  // of each point of the last time
  const auto begin_track = [&](std::size_t time, const CriticalPoint& point) {
    tracks.push_back({time, {point}});
    return tracks.size() - 1;
  };
  Points last;
  for (std::size_t k = 0; k < times.size(); ++k) {
    Points now = points_at(times[k]);
    std::vector<std::size_t> track_now(now.size(), tracks.max_size());
    if (k > 0) {
      const Partners partners = follow(points_at, times[k - 1], last, times[k], now, most_halvings, stop);
      for (std::size_t i = 0; i < last.size(); ++i)
        if (partners[i] != none) {
          track_now[partners[i]] = track_of[i];
          tracks[track_of[i]].points.push_back(now[partners[i]]);
        }
    }
    for (std::size_t i = 0; i < now.size(); ++i)
      if (track_now[i] == tracks.max_size()) track_now[i] = begin_track(k, now[i]);
    last = std::move(now);
    track_of = std::move(track_now);
  }
  return tracks;
}

}  // namespace nacre
