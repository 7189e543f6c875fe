// Nacre: from labelled Delaunay cells to the triangles between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Facets between cells of different labels, and between labelled cells and the outside of the hull: a conformal mesh
/// that is closed around every material. `label` holds one material per cell.
/// Points that no facet uses are left out, the others keep their order; `point_of`, if given, receives the index that
/// each point of the mesh has in `points`. Facets come in the order of the cells.
SurfaceMesh extract_interfaces(std::span<const Vec3d> points, const DelaunayCells& cells,
                               std::span<const std::uint16_t> label, std::vector<std::uint32_t>* point_of = nullptr);

}  // namespace nacre
