// Nacre: meshes of the numerics as those of the library, and back.
#pragma once

#include <span>

#include "compute/meshing/second_order.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/session/mesh_materials.hpp"
#include "include/nacre/mesh.hpp"

namespace nacre {

/// `second` may be null.
Mesh public_mesh(const SurfaceMesh& mesh, const SecondOrder* second, const MeshInput& input);
Tetrahedra public_tetrahedra(const TetrahedralMesh& mesh, const SecondOrder* second);
Particles public_particles(const MeshParticles& particles);

}  // namespace nacre
