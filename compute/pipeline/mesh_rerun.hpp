// Nacre: what has to run again when knobs of the mesh have changed.
#pragma once

#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// The step of MeshPipeline to begin with; each one includes those before it.
enum class MeshRerun {
  nothing,
  triangulate,  ///< from the particles as `relax` left them
  relax,        ///< from the seeds
  fields,       ///< build_fields, which runs those of its stages that are concerned
};

/// Says it without running anything, from the knobs alone. `build_fields` knows more: the volume (scalars are not
/// tightened) and limits (subcells beyond what the smallest size can use), and returns false where no stage had to run.
MeshRerun mesh_rerun(const MeshParameters& before, const MeshParameters& after);

}  // namespace nacre
