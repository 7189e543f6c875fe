// Nacre: the critical points of a flow, followed through the times of its data.
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compute/topology/point_tracks.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

struct FlowTracks {
  std::vector<double> times;
  std::vector<PointTrack> tracks;
};

/// Through the steps of the data that lie in `shown`, and its two ends. `persistence`: as of `flow_skeleton`. Throws
/// Error where the data have one time only; Interrupted where `stop` is set.
FlowTracks flow_tracks(VectorsInTime& input, const Range& shown, double persistence, const std::atomic<bool>* stop);

/// A track up to `now`, and from then on; what has fewer than two points is left out.
struct TrackPart {
  bool past;
  std::vector<Vec3d> points;
};
std::vector<TrackPart> parts_of(const FlowTracks& tracks, const PointTrack& track, double now);

/// The report's key `tracks`.
nlohmann::json tracks_report(const FlowTracks& tracks);

/// As .vtp: a polyline through the positions of each point, with the point arrays `track` (its number), `time`, `kind`,
/// `index` and `persistence` (as in `write_skeleton`); one that is there at one time only is a vertex cell. Throws
/// Error if the file cannot be written.
void write_tracks(const std::filesystem::path& file, const FlowTracks& tracks, const std::string& origin);

}  // namespace nacre
