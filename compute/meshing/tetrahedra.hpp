// Nacre: the insides of the materials filled with tetrahedra.
#pragma once

#include <atomic>

#include "compute/meshing/lattice.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Fills every material of `mesh` but the outside. The facets between materials, and between them and the outside, are
/// exactly the triangles of `mesh`: no point is added to them. Points within are a graded lattice (graded_lattice):
/// near the surface as dense as its vertices, then coarser, but no coarser than `edge_length` says (may be empty); what
/// remains badly shaped is improved by flips and by moving points (improve_cells).
/// The triangles must be facets of the Delaunay triangulation of the mesh's points, as those of extract_interfaces are.
/// Throws Error where they are not, or not closed, or there would be too many cells; Interrupted soon after `*stop` is
/// set. The result depends on the mesh and `edge_length` alone.
TetrahedralMesh fill_with_tetrahedra(const SurfaceMesh& mesh, const EdgeLength& edge_length = {},
                                     const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
