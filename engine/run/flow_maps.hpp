// Nacre: the flow map of a run: computed, reported, written, and as colours.
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// A flow map on the points of the surface, and its finite-time Lyapunov exponents.
struct SurfaceFlowMap {
  std::vector<Vec3d> points;        ///< at `from`
  std::vector<Triangle> triangles;  ///< of the file
  double from = 0, duration = 0;    ///< time of the data; below 0: backward
  std::vector<float> ftle;          ///< 1 / time of the data; NaN where it is not known
  std::vector<float> time;          ///< over how long that was measured
  std::vector<Vec3d> end;           ///< where each point is taken, at the end
  std::size_t left = 0;             ///< points that are taken over a rim
};

/// From the first time that is shown, if `duration` (the knob `ftle_time`) is above 0, or backward from the last. 0: to
/// the last time that is shown; where vectors are steady, as long as the reference speed needs for the longest side.
/// Of a surface that moves, it is that of the vectors on the material, between the shapes of then. Throws Error where
/// the vectors are zero everywhere, where `duration` goes beyond the data or takes particles a thousand times across
/// the surface, and where triangles change; Interrupted where `stop` is set.
SurfaceFlowMap surface_flow_map(VectorsInTime& input, const FlowSpan& shown, double duration,
                                const std::atomic<bool>* stop);

/// The report's key `flow_map`.
nlohmann::json flow_map_report(const SurfaceFlowMap& map);

/// As .vtp: the surface as it is at the beginning, with the point arrays `FTLE`, `ftle_time` (over how long it was
/// measured) and `flow_map` (where the point is taken, world coordinates). Throws Error if the file cannot be written.
void write_flow_map(const std::filesystem::path& file, const SurfaceFlowMap& map, const std::string& origin);

}  // namespace nacre
