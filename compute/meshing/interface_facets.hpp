// Nacre: which facets of labelled Delaunay cells lie between two materials.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Corners of the facet opposite of corner k, counter-clockwise seen from outside of a cell with positive volume.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> facet_corners = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Facets between different labels: `triangles` and `materials` as in SurfaceMesh, but corners are indices of the
/// points that were triangulated; `cell` is the lower-numbered cell at each facet.
struct InterfaceFacets {
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint16_t, 2>> materials;
  std::vector<std::int32_t> cell;
};

/// All of them, in the order of the cells; beyond the hull is material 0.
InterfaceFacets interface_facets(const DelaunayCells& cells, std::span<const std::uint16_t> label);

}  // namespace nacre
