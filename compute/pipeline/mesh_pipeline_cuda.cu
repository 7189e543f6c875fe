// Nacre: the mesh pipeline on CUDA.
#include "compute/device/executor_cuda.cuh"
#include "compute/pipeline/mesh_backends.hpp"
#include "compute/pipeline/mesh_pipeline_impl.hpp"

std::unique_ptr<nacre::MeshPipeline> nacre::make_mesh_pipeline(Cuda, Device& device) {
  return std::make_unique<MeshPipelineOf<Cuda>>(device);
}
