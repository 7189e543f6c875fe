// Nacre: how far the mesh of each material is from the boundary of its voxels.
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// Between the triangles that bound a material and the faces that its voxels share with voxels of other materials, or
/// with what is beyond the volume. World units.
struct VoxelDistance {
  bool measured = false;    ///< both boundaries exist
  double mesh_mean = 0;     ///< from the triangles to the nearest face, over the area of the triangles
  double mesh_max = 0;      ///< the same, the largest: at vertices, and at points at most a voxel apart
  double faces_mean = 0;    ///< from the centres of faces to the nearest triangle, over the area of the faces
  double faces_max = 0;     ///< the same, the largest
  double voxel_volume = 0;  ///< of the material's voxels, world units^3
  double mean() const { return 0.5 * (mesh_mean + faces_mean); }      ///< symmetric
  double hausdorff() const { return std::max(mesh_max, faces_max); }  ///< symmetric
};

/// Per material of `volume`, of which everything but `values` is read; that of the outside, 0, is not measured. Voxels
/// are boxes around their centres, and a body that they sample exactly is not zero away from their faces: see
/// docs/method/chapter-3.md. The same to the last bit on any number of threads. Throws Interrupted soon after `*stop`
/// (may be null) is set.
std::vector<VoxelDistance> voxel_distances(const SurfaceMesh& mesh, const MeshVolume& volume,
                                           const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
