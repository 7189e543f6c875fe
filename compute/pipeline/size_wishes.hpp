// Nacre: an image of wanted sizes in the voxels that fields are computed in.
#pragma once

#include "compute/field/sizing.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// The sizes that `volume.sizes` wants; of `volume` everything but its voxels is read. Wishes are limited to 1000
/// voxels. Throws Error where none lies within the volume, and where one there is below 0.05 voxels.
SizeWishes size_wishes(const MeshVolume& volume);

}  // namespace nacre
