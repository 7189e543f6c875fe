// Nacre: how far a mesh is from the interfaces that it stands for.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compute/field/interface.hpp"
#include "compute/meshing/surface_mesh.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// Points of a mesh whose distance is measured: vertices first, then centres of facets; and the interface of each.
struct DistanceSamples {
  std::vector<Vec3d> points;
  std::vector<Junction> interfaces;
  std::size_t vertices = 0;
};

/// Vertices that no facet uses are left out; one with several interfaces stands for that of its last facet.
DistanceSamples distance_samples(const SurfaceMesh& mesh);

/// Means and maxima of the distances of samples, voxels; negative ones are left out.
SurfaceDistance summarise_distances(const DistanceSamples& samples, std::span<const float> distance);

}  // namespace nacre
