// Nacre: which backend a mesh pipeline runs on, chosen once.
#include "compute/pipeline/mesh_pipeline.hpp"

#include "compute/device/error.hpp"
#include "compute/pipeline/mesh_backends.hpp"

std::unique_ptr<nacre::MeshPipeline> nacre::make_mesh_pipeline(Device& device) {
#if NACRE_HAS_CUDA
  if (device.backend() == "cuda") return make_mesh_pipeline(Cuda{}, device);
#endif
  if (device.backend() == "cpu") return make_mesh_pipeline(Cpu{}, device);
  throw Error("no pipeline for device '" + device.backend() + "'");
}
