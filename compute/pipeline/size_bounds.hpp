// Nacre: bounds on the size of triangles in materials and regions, from text.
#pragma once

#include <string_view>
#include <vector>

#include "compute/field/sizing.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// What MeshParameters::sizes says: WHAT:SIZE[,WHAT:SIZE...], where WHAT is a label, the name of a material,
/// `box x0 y0 z0 x1 y1 z1` or `ball x y z radius` (world units), and SIZE is in voxels. Of `volume` everything but its
/// voxels is read. Throws Error that names the part that cannot be read, and the labels that there are.
std::vector<SizeBound> size_bounds(std::string_view text, const MeshVolume& volume);

}  // namespace nacre
