// Nacre: which backend a flow pipeline runs on, chosen once; its embedded flow.
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

nacre::FlowMethod& nacre::FlowPipeline::flow() {
  if (!method_) throw Error("no surface embedded");
  return *method_;
}

const nacre::FlowMethod& nacre::FlowPipeline::flow() const {
  if (!method_) throw Error("no surface embedded");
  return *method_;
}
