// Nacre: the flow pipeline on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "compute/pipeline/flow_backends.hpp"
#include "compute/pipeline/flow_pipeline_impl.hpp"

std::unique_ptr<nacre::FlowPipeline> nacre::make_flow_pipeline(Cpu, Device& device) {
  return std::make_unique<FlowPipelineOf<Cpu>>(device);
}
