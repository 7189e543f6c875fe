// Nacre: what has to run again when knobs of the flow have changed.
#pragma once

#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// Each one includes those before it.
enum class FlowRerun {
  nothing,
  steps,  ///< the next step takes the new values
  start,  ///< from the noise
  embed   ///< from the triangles
};

FlowRerun flow_rerun(const FlowParameters& before, const FlowParameters& after);

}  // namespace nacre
