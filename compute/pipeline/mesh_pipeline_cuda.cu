// Nacre: the mesh pipeline on CUDA.
#include "compute/device/executor_cuda.cuh"
#include "compute/pipeline/mesh_backends.hpp"
#include "compute/pipeline/mesh_fields_impl.hpp"
#include "compute/pipeline/mesh_look_impl.hpp"
#include "compute/pipeline/mesh_mending_impl.hpp"
#include "compute/pipeline/mesh_relaxation_impl.hpp"

std::unique_ptr<nacre::MeshPipeline> nacre::make_mesh_pipeline(Cuda, Device& device) {
  return std::make_unique<MeshPipelineOf<Cuda>>(device);
}
