// Nacre: meshes of the numerics as those of the library, and back.
#pragma once

#include <span>

#include "compute/meshing/surface_mesh.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/session/mesh_materials.hpp"
#include "include/nacre/mesh.hpp"

namespace nacre {

Mesh public_mesh(const SurfaceMesh& mesh, const MeshInput& input);
Tetrahedra public_tetrahedra(const TetrahedralMesh& mesh);
Particles public_particles(const MeshParticles& particles);

}  // namespace nacre
