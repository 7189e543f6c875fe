// Nacre: the triangles between materials, read off from the particles themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/star_counts.hpp"
#include "compute/meshing/star_device.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

struct StarMesh {
  std::vector<Triangle> triangles;      ///< corners are particles; counter-clockwise seen from the lower material
  std::vector<MaterialPair> materials;  ///< per triangle
  StarCounts counts;
  /// Particles around which triangles are missing, or overlap, ascending: a rim is broken, a hole is too large or
  /// cannot be filled, or what may be a body is left out. Where there are none, the mesh is closed around every
  /// material.
  std::vector<std::uint32_t> unsettled;
  /// Particles at filled holes, at patches, and where a material of no thickness was taken away: surfaces may be
  /// pinched there. Elsewhere they are not: the triangles at a particle are those that it and its neighbours agree on.
  std::vector<std::uint32_t> joined;

  bool sound() const { return unsettled.empty() && !triangles.empty(); }
};

/// The surfaces between all materials as one mesh. Quicker where the particles are much as they were at the last call
/// with this device; the result depends on the particles alone. In parallel.
StarMesh mesh_from_stars(const StarParticles& particles, StarDevice& device);

}  // namespace nacre
