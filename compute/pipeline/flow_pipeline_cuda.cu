// Nacre: the flow pipeline on CUDA.
#include "compute/device/executor_cuda.cuh"
#include "compute/pipeline/flow_backends.hpp"
#include "compute/pipeline/flow_pipeline_impl.hpp"

std::unique_ptr<nacre::FlowPipeline> nacre::make_flow_pipeline(Cuda, Device& device) {
  return std::make_unique<FlowPipelineOf<Cuda>>(device);
}
