// Nacre: what the stages of the mesh pipeline's fields are built from, so that those that stay the same need not run again.
#pragma once

#include "compute/field/sizing.hpp"

namespace nacre {

/// The stages of `build_fields`, in their order. Each one depends on all before it.
enum FieldStage { tighten_stage, distance_stage, sizing_stage, embed_stage, field_stages };

/// Values as the stages see them: two sets of knobs that come to the same are the same.
struct FieldRecipe {
  double width = 0;   ///< tighten: 0 where the volume is not made of labels
  double stairs = 0;  ///< tighten: 0 where width is
  CubicKernel kernel =
      CubicKernel::catmull_rom;  ///< of all stages that read the materials' functions: from distance on
  float spacing = 0.25f;         ///< asked for; the lattice that follows from it is what counts
  Lattice lattice;               ///< distance
  float reach = 0;               ///< distance, voxels
  SizingRule rule;               ///< sizing
  double cells_per_voxel = 0;    ///< embed; limited by the sizing field

  /// How many stages, from the first, are built alike by `other`.
  int alike(const FieldRecipe& other) const {
    if (width != other.width || stairs != other.stairs) return tighten_stage;
    if (kernel != other.kernel || !(lattice == other.lattice) || reach != other.reach) return distance_stage;
    if (!(rule == other.rule)) return sizing_stage;
    return cells_per_voxel != other.cells_per_voxel ? embed_stage : field_stages;
  }
};

}  // namespace nacre
