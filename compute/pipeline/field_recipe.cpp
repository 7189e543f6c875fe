// Nacre: what the stages of the mesh pipeline's fields are built from, so that those that stay the same need not run
// again.
#include "compute/pipeline/field_recipe.hpp"

#include <algorithm>
#include <utility>

#include "compute/pipeline/mesh_choices.hpp"

namespace nacre {

double deviation_detail(const MeshParameters& parameters) { return std::min(parameters.min_size, 0.25); }

int FieldRecipe::alike(const FieldRecipe& other) const {
  if (width != other.width || stairs != other.stairs) return tighten_stage;
  if (kernel != other.kernel || !(lattice == other.lattice) || reach != other.reach) return distance_stage;
  if (!(rule == other.rule) || bounds != other.bounds) return sizing_stage;
  return cells_per_voxel != other.cells_per_voxel || seeds_only != other.seeds_only ? embed_stage : field_stages;
}

FieldRecipe field_recipe(const MeshParameters& parameters, MeshVolume::Kind kind, const MaterialBricks& bricks,
                         std::vector<SizeBound> bounds, const SizeWishes* wishes, float small) {
  FieldRecipe recipe;
  if (kind == MeshVolume::Kind::labels) recipe.width = parameters.tighten;
  if (recipe.width > 0) recipe.stairs = parameters.stairs;
  recipe.kernel = kernel_from_string(parameters.kernel);
  recipe.rule = {float(parameters.epsilon),
                 float(parameters.delta),
                 float(parameters.min_size),
                 float(std::max(parameters.min_size, parameters.max_size)),
                 parameters.curvature,
                 float(parameters.max_deviation),
                 float(deviation_detail(parameters))};
  recipe.bounds = std::move(bounds);
  float least = recipe.rule.min_size;
  for (const SizeBound& bound : recipe.bounds) least = std::min(least, bound.size);
  if (wishes) least = std::min(least, wishes->least);
  if (recipe.rule.deviation > 0) least = std::min(least, 1.0f);  // curvature is looked for everywhere
  recipe.spacing = 0.5f * least;
  recipe.lattice = lattice_over(bricks, recipe.spacing);
  recipe.reach = std::min(widest_rule(recipe.rule, recipe.bounds, wishes).reach() + 2, 64.0f);
  // Cells of two thirds of the smallest distance of particles suffice for the stencils. They are searched voxel by
  // voxel for what meets there, so that a few are no cheaper than many, and one that is larger than the volume takes
  // forever.
  constexpr double fewest = 0.125, to_a_size = 1.5, thin = 0.75;
  recipe.seeds_only = projection_from_string(parameters.projection) == Projection::fields;
  // Where sheets are nearer to each other than their particles may be, each needs cells of its own.
  const bool draft = quality_from_string(parameters.quality) == QualityLevel::draft;
  const int finer = small < thin * parameters.min_size && !draft ? 2 : 1;
  recipe.cells_per_voxel = std::clamp(to_a_size / small, fewest, double(finer * parameters.subcells));
  return recipe;
}

}  // namespace nacre
