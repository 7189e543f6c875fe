// Nacre: the values of a flow from all processes that share it.
#pragma once

#include "compute/device/ranks.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// Puts the values of all processes one after the other, on the first of them; on the others none are left. Collective.
void gather_values(Ranks& ranks, FlowValues& values);

}  // namespace nacre
