// Nacre: the topology of the flow at one time: computed, reported, written.
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compute/topology/critical_points.hpp"
#include "compute/topology/surface_lines.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Critical points and the separatrices between them.
struct FlowSkeleton {
  PreparedSurface shape;  ///< as it is at that time
  double time = 0;
  double least_persistence = 0;  ///< unit of the vectors
  FlowTopology topology;
  std::vector<SurfaceLine> separatrices;
};

/// Of the tangential vectors at time `t` of the data, on the surface as it is then. Points at one position count as
/// one, but for those of a second sheet. `persistence`: a share of the reference speed; zeros that cancel below it are
/// left out.
FlowSkeleton flow_skeleton(VectorsInTime& input, double t, double persistence);

/// The report's key `topology`.
nlohmann::json skeleton_report(const FlowSkeleton& skeleton);

/// As .vtp: a vertex cell for each critical point, and after them a polyline for each separatrix. Point arrays:
/// `kind` (0 saddle, 1 source, 2 sink, 3 focus source, 4 focus sink, 5 centre; 6 a separatrix with the flow, 7 against
/// it), `index` (0 on separatrices), `persistence` (that of the saddle), `eigenvalue_real` and `eigenvalue_imaginary`
/// (two components; 0 on separatrices). `origin`: how it came about (origin.hpp).
/// Throws Error if the file cannot be written.
void write_skeleton(const std::filesystem::path& file, const FlowSkeleton& skeleton, const std::string& origin);

/// Evenly spaced streamlines (compute/topology/even_lines.hpp) of time `t` as .vtp: a polyline each, with the point
/// array `speed`. `spacing`: a share of the longest side of the bounding box. Returns how many there are. Throws Error
/// if the file cannot be written, Interrupted where `stop` is set.
std::size_t write_streamlines(const std::filesystem::path& file, VectorsInTime& input, double t, double spacing,
                              const std::string& origin, const std::atomic<bool>* stop);

}  // namespace nacre
