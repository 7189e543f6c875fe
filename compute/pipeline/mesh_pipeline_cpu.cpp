// Nacre: the mesh pipeline on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "compute/pipeline/mesh_backends.hpp"
#include "compute/pipeline/mesh_pipeline_impl.hpp"

std::unique_ptr<nacre::MeshPipeline> nacre::make_mesh_pipeline(Cpu, Device& device) {
  return std::make_unique<MeshPipelineOf<Cpu>>(device);
}
