// Nacre: the critical points of a flow, followed through the times of its data.
#include "engine/run/flow_tracks.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/io/vtp_writer.hpp"
#include "engine/run/flow_skeleton.hpp"

namespace nacre {

FlowTracks flow_tracks(VectorsInTime& input, const Range& shown, double persistence, const std::atomic<bool>* stop) {
  if (!(shown.high > shown.low))
    throw Error("critical points cannot be followed in time", input.series().name + " has one time only");
  FlowTracks result;
  result.times.push_back(shown.low);
  for (const double t : input.series().times)
    if (t > shown.low && t < shown.high) result.times.push_back(t);
  result.times.push_back(shown.high);
  const auto points_at = [&](double t) { return flow_critical_points(input, t, persistence); };
  result.tracks = track_points(points_at, result.times, stop);
  return result;
}

std::vector<TrackPart> parts_of(const FlowTracks& all, const PointTrack& track, double now) {
  TrackPart past{true, {}}, later{false, {}};
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    const double t = all.times[track.first + i];
    const Vec3d& p = track.points[i].position;
    if (t > now && later.points.empty() && i > 0) {  // where it is now belongs to both
      const double before = all.times[track.first + i - 1];
      const Vec3d& q = track.points[i - 1].position;
      const Vec3d middle = q + (p - q) * ((now - before) / (t - before));
      past.points.push_back(middle);
      later.points.push_back(middle);
    }
    (t > now ? later : past).points.push_back(p);
  }
  std::vector<TrackPart> parts;
  for (TrackPart* part : {&later, &past})
    if (part->points.size() > 1) parts.push_back(std::move(*part));
  return parts;
}

nlohmann::json tracks_report(const FlowTracks& all) {
  std::size_t through = 0, appear = 0, vanish = 0, longest = 0;
  for (const PointTrack& track : all.tracks) {
    const bool from_first = track.first == 0, to_last = track.first + track.points.size() == all.times.size();
    through += from_first && to_last;
    appear += !from_first;
    vanish += !to_last;
    longest = std::max(longest, track.points.size());
  }
  return {{"times", all.times.size()}, {"count", all.tracks.size()}, {"through_all_times", through},
          {"appear", appear},          {"vanish", vanish},           {"longest", longest}};
}

void write_tracks(const std::filesystem::path& file, const FlowTracks& all, const std::string& origin) {
  std::vector<Vec3d> points;
  PointArray number{"track", 1, {}}, time{"time", 1, {}}, kind{"kind", 1, {}}, index{"index", 1, {}},
      persistence{"persistence", 1, {}};
  const auto add = [&](std::size_t k) {
    const PointTrack& track = all.tracks[k];
    for (std::size_t i = 0; i < track.points.size(); ++i) {
      const CriticalPoint& p = track.points[i];
      points.push_back(p.position);
      number.values.push_back(float(k));
      time.values.push_back(float(all.times[track.first + i]));
      kind.values.push_back(float(p.kind));
      index.values.push_back(float(p.index));
      persistence.values.push_back(float(p.persistence));
    }
  };
  for (std::size_t k = 0; k < all.tracks.size(); ++k)
    if (all.tracks[k].points.size() == 1) add(k);
  const std::size_t single = points.size();
  std::vector<std::uint64_t> starts{single};
  for (std::size_t k = 0; k < all.tracks.size(); ++k)
    if (all.tracks[k].points.size() > 1) {
      add(k);
      starts.push_back(points.size());
    }
  if (starts.size() == 1) starts.clear();
  write_vtp_lines(file, points, single, starts, std::vector<PointArray>{number, time, kind, index, persistence},
                  std::nullopt, xml_origin(origin));
}

}  // namespace nacre
