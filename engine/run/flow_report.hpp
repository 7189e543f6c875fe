// Nacre: the report of a flow run.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/run/focus.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// The report's own part: input, parameters, embedding, flow, and the focus where there is one. `seconds`: how long
/// each step took; `first_step`: the number of the first, not 0 for a part of a run.
void add_flow_report(nlohmann::json& report, const VectorsInTime& input, const FlowVectors& vectors,
                     const Settings& settings, const EmbeddingInfo& embedding, const std::vector<double>& seconds,
                     const Focus* focus = nullptr, int first_step = 0);

}  // namespace nacre
