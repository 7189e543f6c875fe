// Nacre: what the stages of the mesh pipeline's fields are built from, so that those that stay the same need not run
// again.
#pragma once

#include "compute/field/build_material_bricks.hpp"
#include "compute/field/sizing.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// The stages of `build_fields`, in their order. Each one depends on all before it.
enum FieldStage { tighten_stage, distance_stage, sizing_stage, embed_stage, field_stages };

/// Values as the stages see them: two sets of knobs that come to the same are the same.
struct FieldRecipe {
  double width = 0;   ///< tighten: 0 where the volume is not made of labels
  double stairs = 0;  ///< tighten: 0 where width is
  CubicKernel kernel =
      CubicKernel::catmull_rom;   ///< of all stages that read the materials' functions: from distance on
  float spacing = 0.25f;          ///< asked for; the lattice that follows from it is what counts
  Lattice lattice;                ///< distance
  float reach = 0;                ///< distance, voxels
  SizingRule rule;                ///< sizing
  std::vector<SizeBound> bounds;  ///< sizing: in materials and regions
  double cells_per_voxel = 0;     ///< embed; limited by the sizing field
  bool seeds_only = false;        ///< embed: not for stencils: particles are projected by the fields

  /// How many stages, from the first, are built alike by `other`.
  int alike(const FieldRecipe& other) const;
};

/// The smallest distance of particles that a bound on the deviation may ask for, voxels: interfaces have no detail
/// below a quarter of a voxel.
double deviation_detail(const MeshParameters& parameters);

/// The recipe that `parameters` ask for on a volume of this kind, laid out as `bricks`; `bounds` are what its `sizes`
/// say, `wishes` (may be null) those of the volume. The cells of the embedding are limited by `small`,
/// SizingField::small of the present sizing field: where that is built again, so is the embedding.
FieldRecipe field_recipe(const MeshParameters& parameters, MeshVolume::Kind kind, const MaterialBricks& bricks,
                         std::vector<SizeBound> bounds, const SizeWishes* wishes, float small);

}  // namespace nacre
