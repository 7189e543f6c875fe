// Nacre: what meshing gives: triangles between materials, tetrahedra within them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// The materials on the two sides of a triangle, or of an interface; the smaller number first.
using MaterialPair = std::array<std::uint16_t, 2>;

/// The interfaces of all materials as one conformal mesh. Materials are numbers as in MeshVolume: 0 is the outside.
struct SurfaceMesh {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;      ///< seen from the side of materials[0], corners run counter-clockwise
  std::vector<MaterialPair> materials;  ///< per triangle: normals point out of the higher one
};

/// Tetrahedra with positive volume; the facets between different materials are exactly those of a SurfaceMesh.
struct TetrahedralMesh {
  std::vector<Vec3d> points;  ///< those of the surface mesh first, in its order
  std::vector<std::array<std::uint32_t, 4>> cells;
  std::vector<std::uint16_t> material;  ///< per cell, never 0
};

}  // namespace nacre
