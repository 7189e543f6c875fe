// Nacre: what `nacre flow` finds out beside the texture, and writes into files of its own.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/run.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/run/dye_run.hpp"
#include "engine/run/origin.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

struct FlowOptions {
  CommonOptions common;
  InputOptions input;
  std::string image, frames, video, out, haemodynamics, topology_out, streamlines_out, ftle_out, tracks_out;
  std::string chunk;  ///< I/N: this part of the steps only
  int lead_in = 256;  ///< steps before it
  std::string checkpoint;
  double checkpoint_every = 10;  ///< minutes
};

/// The first shape with the means of the vectors over time.
void write_haemodynamics(const std::string& file, VectorsInTime& input, const Origin& origin);

/// The flow map where it is asked for, as a file or as colours. Returns its part of the report, and adds to the
/// outputs.
nlohmann::json make_flow_map(const FlowOptions& options, StageTimers& timers, VectorsInTime& input,
                             const FlowSpan& span, const Settings& settings, const Origin& origin,
                             std::vector<std::string>& outputs);

/// Topology and streamlines of the last frame, and the critical points of all times, as far as they are asked for.
/// Returns their part of the report, and adds to the outputs.
nlohmann::json write_lines(const FlowOptions& options, FlowPipeline& pipeline, VectorsInTime& input,
                           const FlowSpan& span, const Settings& settings, const Origin& origin,
                           std::vector<std::string>& outputs);

}  // namespace nacre
