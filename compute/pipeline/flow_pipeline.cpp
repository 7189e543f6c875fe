// Nacre: which backend a flow pipeline runs on, chosen once.
#include "compute/pipeline/flow_pipeline.hpp"

#include "compute/device/error.hpp"
#include "compute/pipeline/flow_backends.hpp"

std::unique_ptr<nacre::FlowPipeline> nacre::make_flow_pipeline(Device& device) {
#if NACRE_HAS_CUDA
  if (device.backend() == "cuda") return make_flow_pipeline(Cuda{}, device);
#endif
  if (device.backend() == "cpu") return make_flow_pipeline(Cpu{}, device);
  throw Error("no pipeline for device '" + device.backend() + "'");
}
