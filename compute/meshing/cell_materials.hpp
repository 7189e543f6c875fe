// Nacre: which material each Delaunay cell of a surface mesh's points lies in.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// The cells of points of which the first ones are those of a surface mesh, seen against that mesh.
struct CellMaterials {
  std::vector<std::uint16_t> material;  ///< per cell; empty where `missing` is not
  std::vector<std::uint32_t> missing;   ///< triangles of the mesh that are no facet of a cell
  std::vector<std::array<std::int32_t, 2>>
      cells_at;  ///< per triangle: the cells on the two sides of its materials; -1: hull
};

/// Finds the triangles among the facets and lets their materials flood the cells between them. Throws Error where they
/// do not close off one material from another.
CellMaterials cell_materials(const DelaunayCells& cells, const SurfaceMesh& mesh);

/// The material at each of `positions`, by walking through the cells; 0 outside of the hull.
std::vector<std::uint16_t> materials_at(std::span<const Vec3d> positions, std::span<const Vec3d> points,
                                        const DelaunayCells& cells, std::span<const std::uint16_t> material);

}  // namespace nacre
