// Nacre: from labelled Delaunay cells to the triangles between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// The mesh of these triangles. Points that none uses are left out, the others keep their order; `point_of`, if given,
/// receives the index that each point of the mesh has in `points`.
SurfaceMesh mesh_of_triangles(std::span<const Vec3d> points, std::vector<Triangle> triangles,
                              std::vector<std::array<std::uint16_t, 2>> materials,
                              std::vector<std::uint32_t>* point_of = nullptr);

/// Facets between cells of different labels, and between labelled cells and the outside of the hull: a conformal mesh
/// that is closed around every material. `label` holds one material per cell.
/// Facets come in the order of the cells; points and `point_of` as in `mesh_of_triangles`.
SurfaceMesh extract_interfaces(std::span<const Vec3d> points, const DelaunayCells& cells,
                               std::span<const std::uint16_t> label, std::vector<std::uint32_t>* point_of = nullptr);

}  // namespace nacre
