// Nacre: the mesh pipeline's two instantiations.
#pragma once

#include "compute/device/backend.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

std::unique_ptr<MeshPipeline> make_mesh_pipeline(Cpu, Device& device);
std::unique_ptr<MeshPipeline> make_mesh_pipeline(Cuda, Device& device);

}  // namespace nacre
