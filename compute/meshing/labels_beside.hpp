// Nacre: materials of Delaunay cells beside triangles that are known.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Gives each cell that has one of the triangles for a facet the material on its side; one whose triangles disagree
/// keeps its label. Corners are numbers of the points that were triangulated; `materials`
/// and the sense of the triangles are as in SurfaceMesh.
void label_beside(const DelaunayCells& cells, std::span<const Triangle> triangles,
                  std::span<const std::array<std::uint16_t, 2>> materials, std::span<std::uint16_t> label);

}  // namespace nacre
