// Nacre: the flow pipeline's two instantiations.
#pragma once

#include "compute/device/backend.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

std::unique_ptr<FlowPipeline> make_flow_pipeline(Cpu, Device& device);
std::unique_ptr<FlowPipeline> make_flow_pipeline(Cuda, Device& device);

}  // namespace nacre
