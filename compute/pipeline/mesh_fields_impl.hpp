// Nacre: the part of the mesh pipeline that makes fields of a volume, and makes only those again that have to change.
#pragma once

#include <algorithm>
#include <cmath>

#include "compute/field/boundary_area.hpp"
#include "compute/field/tighten.hpp"
#include "compute/pipeline/mesh_pipeline_impl.hpp"

namespace nacre {

inline CubicKernel cubic_kernel(const MeshParameters& parameters) {
  return parameters.kernel == "b-spline" ? CubicKernel::b_spline : CubicKernel::catmull_rom;
}

template <class Backend>
void MeshPipelineOf<Backend>::load(const MeshVolume& volume) {
  auto stage = exec_.stage("materials");
  Arena& arena = exec_.arena();
  drop_particles();
  kind_.reset();
  built_ = 0;
  info_ = {};
  arena.rewind(0);
  frame_ = VolumeFrame(volume);
  tell("materials", 0);
  bricks_ = lay_out_bricks(exec_, volume.dims, frame_.relative_spacing(), cubic_kernel(parameters), volume.material);
  if (bricks_.bricks == 2)
    throw Error("one material only", "every voxel of the volume is of the same material",
                "choose others with --materials or --isovalue");
  if (volume.kind == MeshVolume::Kind::indicators) {
    fill_indicators(exec_, bricks_, volume.material, volume.values,
                    indicator_range(volume.dims, volume.material, volume.values));
  } else if (volume.kind == MeshVolume::Kind::scalar) {
    const std::vector<float>& values = volume.values.at(0);
    float scale = 0;
    for (const float v : values) scale = std::max(scale, std::fabs(v));
    const Vec3f spacing(frame_.relative_spacing());
    const float slope = volume.levels.size() == 1 ? distance_slope(volume.dims, spacing, values, volume.levels[0]) : 0;
    info_.creased_voxels = fill_scalar(exec_, bricks_, values, volume.levels, scale > 0 ? scale : 1, slope);
  }
  least_area_ = least_boundary_area(exec_, bricks_);
  info_.blocks = bricks_.blocks;
  mark_[0] = arena.mark();
  kind_ = volume.kind;
}

/// What the fields shall be built from. The cells of the embedding are as the present sizing field has them: where that is
/// to be built anew, so is the embedding.
template <class Backend>
FieldRecipe MeshPipelineOf<Backend>::field_recipe() const {
  FieldRecipe recipe;
  if (kind_ == MeshVolume::Kind::labels) recipe.width = parameters.tighten;
  if (recipe.width > 0) recipe.stairs = parameters.stairs;
  recipe.kernel = cubic_kernel(parameters);
  recipe.rule = {float(parameters.epsilon), float(parameters.delta), float(parameters.min_size),
                 float(std::max(parameters.min_size, parameters.max_size)), parameters.curvature};
  recipe.spacing = 0.5f * recipe.rule.min_size;
  recipe.lattice = lattice_over(bricks_, recipe.spacing);
  recipe.reach = std::min(recipe.rule.reach() + 2, 64.0f);
  // Cells of two thirds of the smallest distance of particles suffice for the stencils. They are searched voxel by voxel for
  // what meets there, so that a few are no cheaper than many, and one that is larger than the volume takes forever.
  constexpr double fewest = 0.125, to_a_size = 1.5;
  recipe.cells_per_voxel = std::clamp(to_a_size / size_.small, fewest, double(parameters.subcells));
  return recipe;
}

/// Refuses sizes that would need more particles than memory before the fields are made, as far as voxels tell: a plane of
/// particles max_size apart is the least that there can be. What the fields say is looked at again in `make_solver`.
template <class Backend>
void MeshPipelineOf<Backend>::require_room() {
  const double h = std::max(parameters.min_size, parameters.max_size);
  if (parameters.particles == 0) require_room_for(least_area_ * 1.1547 / (h * h), "the boundaries ask for at least ");
}

template <class Backend>
bool MeshPipelineOf<Backend>::build_fields() {
  if (!kind_) throw Error("no volume loaded");
  const FieldRecipe wanted = field_recipe();
  built_ = std::min(built_, recipe_.alike(wanted));
  if (built_ == field_stages) return false;
  drop_particles();
  Arena& arena = exec_.arena();
  arena.rewind(mark_[built_]);
  require_room();
  recipe_ = wanted;
  bricks_.kernel = recipe_.kernel;
  while (built_ < field_stages) {  // a stage that is interrupted is not counted, and begins anew
    arena.rewind(mark_[built_]);
    build_stage(FieldStage(built_));
    mark_[++built_] = arena.mark();
  }
  return true;
}

template <class Backend>
void MeshPipelineOf<Backend>::build_stage(FieldStage which) {
  static constexpr std::string_view name[] = {"tighten", "distance", "sizing", "embed"};
  static constexpr double fraction[] = {0.02, 0.05, 0.08, 0.12};
  if (which == tighten_stage && kind_ != MeshVolume::Kind::labels) return;
  auto stage = exec_.stage(name[which]);
  tell(name[which], fraction[which]);
  switch (which) {
    case tighten_stage: info_.constrained_voxels = tighten(exec_, bricks_, recipe_.width, recipe_.stairs).held; break;
    case distance_stage: distance_ = distance_field(exec_, bricks_, recipe_.spacing, recipe_.reach); break;
    case sizing_stage: size_ = sizing_field(exec_, distance_, recipe_.rule); break;
    default:
      recipe_.cells_per_voxel = field_recipe().cells_per_voxel;
      grid_ = embed_interfaces(exec_, bricks_, distance_, size_, recipe_.cells_per_voxel);
      relate_interfaces();
      describe_fields();
  }
}

template <class Backend>
void MeshPipelineOf<Backend>::describe_fields() {
  info_.smallest_size = size_.smallest;
  info_.largest_size = size_.largest;
  info_.field_bytes = bricks_.bytes() + distance_.bytes() + std::int64_t(size_.h.bytes());
  info_.embedding_bytes = grid_.bytes();
  info_.embedding_cells = grid_.cells();
  info_.surfaces = info_.curves = 0;
  for (const Junction& j : grid_.junctions) ++(j.order() == 2 ? info_.surfaces : info_.curves);
  info_.points = int(grid_.points.size());
  info_.crowded_points = grid_.crowded_points;
  info_.crowded_cells = grid_.crowded_cells;
  info_.expected_particles = info_.points;
  for (const int order : {1, 2}) info_.expected_particles += expected_particles(exec_, embedding_seeds(order));
}

/// Which interfaces bound which, and the kinds of junction points as interfaces of their own.
template <class Backend>
void MeshPipelineOf<Backend>::relate_interfaces() {
  junctions_ = grid_.junctions;
  std::vector<Junction> points = grid_.point_junction;
  std::sort(points.begin(), points.end(), [](const Junction& a, const Junction& b) { return a.packed < b.packed; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  junctions_.insert(junctions_.end(), points.begin(), points.end());
  if (junctions_.size() > most_interfaces)
    throw Error("too many interfaces",
                std::to_string(junctions_.size()) + " pairs, triples and quadruples of materials meet",
                "merge materials with --merge or keep fewer with --materials");
  info_.junctions.clear();
  for (const Junction& j : junctions_) info_.junctions.push_back(j.all());
  std::vector<std::uint32_t> start{0}, related;
  std::vector<std::uint8_t> order;
  std::vector<std::vector<std::uint32_t>> with(0x10000);  // per material: its curves and points
  for (std::size_t l = 0; l < junctions_.size(); ++l)
    for (int m = 0; junctions_[l].order() < 2 && m < junctions_[l].materials(); ++m)
      with[junctions_[l].material(m)].push_back(std::uint32_t(l));
  for (std::size_t k = 0; k < junctions_.size(); ++k) {
    related.push_back(std::uint32_t(k));
    for (const std::uint32_t l : with[junctions_[k].material(0)])
      if (junctions_[l].order() < junctions_[k].order() && junctions_[l].bounds(junctions_[k])) related.push_back(l);
    start.push_back(std::uint32_t(related.size()));
    order.push_back(std::uint8_t(junctions_[k].order()));
  }
  Arena& arena = exec_.arena();
  junction_ = arena.permanent_copy<Junction>(junctions_);
  related_start_ = arena.permanent_copy<std::uint32_t>(start);
  related_ = arena.permanent_copy<std::uint32_t>(related);
  order_ = arena.permanent_copy<std::uint8_t>(order);
}

}  // namespace nacre
