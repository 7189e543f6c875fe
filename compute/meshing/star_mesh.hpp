// Nacre: the triangles between materials, read off from the particles themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/star_counts.hpp"
#include "compute/meshing/stars.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

struct StarMesh {
  std::vector<Triangle> triangles;  ///< corners are particles; counter-clockwise seen from the lower material
  std::vector<std::array<std::uint16_t, 2>> materials;  ///< per triangle, ascending
  StarCounts counts;
  /// Every rim is whole, every hole is filled, nothing that may be a body is left out, and few stars disagree. Only
  /// then is the mesh closed around every material, and fit for use.
  bool sound = false;
};

/// The surfaces between all materials as one mesh. In parallel; the result depends on the particles alone. Where
/// stars disagree beyond what filling mends, the mesh is not sound, and the Delaunay triangulation is to be used.
StarMesh mesh_from_stars(const StarParticles& particles);

}  // namespace nacre
