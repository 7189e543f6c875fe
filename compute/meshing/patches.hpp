// Nacre: connected groups of bad triangles, each of which can be judged by itself.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/defects.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Points in pieces that are apart from each other.
struct Patches {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of;  ///< per point: the number of its patch, or `none`
};

/// The marked points of a mesh and their neighbours; one patch where they hang together. Numbered by their first
/// points.
Patches patches_around(const SurfaceMesh& mesh, std::span<const std::uint8_t> marked);

/// The fitness (defects.hpp) of the triangles that have a corner in a patch, per patch; -1 where one of the edges or
/// vertices `touching` has a point in it. `order` and `patch_of` are per point of the mesh, which may have changed
/// since the patches were found: points that are new belong to none, or to one that is next to them (see join_patches).
std::vector<double> patch_fitness(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule,
                                  std::span<const std::array<std::uint32_t, 2>> touching,
                                  std::span<const std::uint32_t> patch_of, std::uint32_t count);

/// Gives each of the points `joining` the patch of one of its neighbours, if one has one.
void join_patches(const SurfaceMesh& mesh, std::span<const std::uint8_t> joining, std::vector<std::uint32_t>& patch_of);

}  // namespace nacre
