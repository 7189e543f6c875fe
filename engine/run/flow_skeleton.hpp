// Nacre: the topology and the streamlines of the flow at one time: computed, reported, written.
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compute/topology/closed_orbits.hpp"
#include "compute/topology/critical_points.hpp"
#include "compute/topology/even_lines.hpp"
#include "compute/topology/separation_lines.hpp"
#include "compute/topology/surface_lines.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Critical points, the separatrices between them, lines of separation and attachment, and closed orbits.
struct FlowSkeleton {
  PreparedSurface shape;  ///< as it is at that time
  double time = 0;
  double least_persistence = 0;  ///< unit of the vectors
  FlowTopology topology;
  std::vector<SurfaceLine> separatrices;
  std::vector<SeparationLine> separation;  ///< and attachment; of strength 1 and more
  std::vector<ClosedOrbit> orbits;
};

/// Of the tangential vectors at time `t` of the data, on the surface as it is then. Points at one position count as
/// one, but for those of a second sheet. `persistence`: a share of the reference speed; zeros that cancel below it are
/// left out.
FlowSkeleton flow_skeleton(VectorsInTime& input, double t, double persistence);
/// Its critical points alone.
std::vector<CriticalPoint> flow_critical_points(VectorsInTime& input, double t, double persistence);

/// The report's key `topology`.
nlohmann::json skeleton_report(const FlowSkeleton& skeleton);

/// As .vtp: a vertex cell for each critical point, and after them a polyline for each separatrix, line of separation or
/// attachment, and closed orbit. Point arrays: `kind` (0 saddle, 1 source, 2 sink, 3 focus source, 4 focus sink, 5
/// centre; 6 a separatrix with the flow, 7 against it; 8 separation, 9 attachment; 10 an orbit that attracts, 11 one
/// that repels), `index` (0 on lines), `persistence` (on a separatrix that of the saddle; else 0), `strength` (by how
/// many powers of e neighbours come nearer along a line of separation, or in a round; else 0), `eigenvalue_real` and
/// `eigenvalue_imaginary` (two components; 0 on lines). `origin`: how it came about (origin.hpp). Throws Error if the
/// file cannot be written.
void write_skeleton(const std::filesystem::path& file, const FlowSkeleton& skeleton, const std::string& origin);

/// Streamlines that lie evenly (compute/topology/even_lines.hpp).
struct FlowStreamlines {
  PreparedSurface shape;  ///< as it is at that time
  double time = 0;
  std::vector<EvenLine> lines;
};

/// As `flow_skeleton`. `spacing`: a share of the longest side of the bounding box. Throws Interrupted where `stop` is
/// set.
FlowStreamlines flow_streamlines(VectorsInTime& input, double t, double spacing, const std::atomic<bool>* stop);

/// As .vtp: a polyline each, with the point array `speed`. Throws Error if the file cannot be written.
void write_streamlines(const std::filesystem::path& file, const FlowStreamlines& streamlines,
                       const std::string& origin);

}  // namespace nacre
