// Nacre: surface nets, a quick mesh of the interfaces between labelled voxels, to be shown until there is a better one.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// A material number per voxel, x fastest; beyond the voxels is the outside, number 0.
struct MaterialVoxels {
  Int3 dims{};                              ///< at least 1 along each axis
  std::span<const std::uint16_t> material;  ///< dims.x * dims.y * dims.z
  Vec3d origin{};                           ///< world position of voxel (0, 0, 0)'s centre
  std::array<Vec3d, 3> steps{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};  ///< world, from voxel to voxel; may be
                                                                               ///< left-handed
};

struct SurfaceNetsOptions {
  int smoothing = 8;                        ///< sweeps that pull each vertex towards its neighbours; 0: none
  int stride = 1;                           ///< every so many voxels along each axis count, at least 1
  const std::atomic<bool>* stop = nullptr;  ///< throws Interrupted soon after it is set; may be null
};

/// One mesh of all interfaces: closed around every material, triangles turned as in SurfaceMesh. A vertex lies in each
/// cell of eight voxels that are not all alike, and stays in it (S. F. F. Gibson, MICCAI 1998); where three or more
/// materials meet it follows only neighbours where they meet as well, so that junctions stay sharp (S. F. Frisken, JCGT
/// 11, 2022). Smoothing takes up to about a quarter of a voxel from a round body. Materials that touch at an edge or a
/// corner of voxels share vertices there, so the mesh need not be a manifold. The same on any number of threads.
SurfaceMesh surface_nets(const MaterialVoxels& voxels, const SurfaceNetsOptions& options = {});

/// The least stride that leaves at most `most` voxels.
int surface_nets_stride(const Int3& dims, std::size_t most);

}  // namespace nacre
