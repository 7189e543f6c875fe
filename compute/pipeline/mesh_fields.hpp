// Nacre: the fields of a volume: built stage by stage, and only those stages again that have to change.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "compute/embedding/build_interface_grid.hpp"
#include "compute/embedding/junction_table.hpp"
#include "compute/field/boundary_area.hpp"
#include "compute/field/thin_materials.hpp"
#include "compute/field/tighten.hpp"
#include "compute/particles/embedding_seeds.hpp"
#include "compute/particles/projectors.hpp"
#include "compute/particles/tree_forces.hpp"
#include "compute/pipeline/field_recipe.hpp"
#include "compute/pipeline/memory_estimate.hpp"
#include "compute/pipeline/mesh_choices.hpp"
#include "compute/pipeline/size_bounds.hpp"
#include "compute/pipeline/size_wishes.hpp"
#include "compute/pipeline/stage_progress.hpp"
#include "compute/pipeline/volume_frame.hpp"

namespace nacre {

/// Functions of the materials, distances, sizes and the embedding of a volume, in permanent memory of the executor's
/// arena from its beginning; what others put behind `end()` is theirs. What is found out is noted in a MeshInfo.
template <class Backend>
class MeshFields {
 public:
  explicit MeshFields(Executor<Backend>& exec) : exec_(exec) {}

  /// Lays out the volume, which is not needed after it. Throws Error where it is of one material.
  void load(const MeshVolume& volume, const MeshParameters& parameters, MeshInfo& info);
  bool loaded() const { return kind_.has_value(); }

  /// Drops the stages that are built otherwise than `parameters` ask for, and the memory behind them. False where all
  /// are built.
  bool drop_outdated(const MeshParameters& parameters);
  /// Runs the stages that are not built. One that is interrupted starts over the next time.
  void build(const MeshParameters& parameters, const TellStage& tell, MeshInfo& info);
  bool built() const { return built_ == field_stages; }
  std::size_t end() const { return mark_[field_stages]; }  ///< the arena's mark behind the last stage

  const VolumeFrame& frame() const { return frame_; }
  std::vector<SizeBound> bounds(const MeshParameters& p) const { return size_bounds(p.sizes, described_); }
  const SizeWishes* wishes() const { return wishes_ ? &*wishes_ : nullptr; }  ///< null: the volume has none
  const BoundaryArea& area() const { return area_; }                          ///< from the voxels
  VolumeFacts facts(const MeshParameters& parameters);                        ///< before the fields are built
  const MaterialBricks& bricks() const { return bricks_; }
  const DistanceField& distance() const { return distance_; }
  const SizingField& size() const { return size_; }
  const InterfaceGrid& grid() const { return grid_; }
  const JunctionTable& table() const { return table_; }

  const Array<Junction>& junctions() const { return junction_; }  ///< the table's, on the device
  const std::uint8_t* order() const { return order_.data(); }     ///< the table's, on the device
  RelatedView related() const { return {related_start_.data(), related_.data(), order_.data()}; }
  double expected(int order) const { return expected_[order]; }  ///< particles, from area and sizing field
  EmbeddingSeeds seeds(int order) const { return {grid_, order_.data(), order}; }
  FieldProjector field_projector() const {
    return {bricks_.view(), junction_.data(), size_.view(), recipe_.seeds_only ? 0.04f : 0.01f};
  }
  EmbeddedProjector embedded_projector() const { return {grid_.view(), field_projector()}; }

 private:
  FieldRecipe recipe(const MeshParameters& p) const {
    return field_recipe(p, *kind_, bricks_, size_bounds(p.sizes, described_), wishes(), size_.small);
  }
  void build_stage(FieldStage which, const MeshParameters& parameters, MeshInfo& info);
  void relate_interfaces(MeshInfo& info);
  void describe(MeshInfo& info);

  Executor<Backend>& exec_;
  VolumeFrame frame_;
  MeshVolume described_;                  ///< the volume without its voxels
  std::optional<MeshVolume::Kind> kind_;  ///< of the volume; none: none is loaded
  std::optional<SizeWishes> wishes_;
  MaterialBricks bricks_;
  BoundaryArea area_;
  DistanceField distance_;
  SizingField size_;
  InterfaceGrid grid_;
  JunctionTable table_;
  Array<Junction> junction_;
  Array<std::uint32_t> related_start_, related_;
  Array<std::uint8_t> order_;
  double expected_[3] = {};
  FieldRecipe recipe_;
  int built_ = 0;                            ///< so many stages are as `recipe_` says
  std::size_t mark_[field_stages + 1] = {};  ///< the arena's head before each stage, and behind the last
};

template <class Backend>
void MeshFields<Backend>::load(const MeshVolume& volume, const MeshParameters& parameters, MeshInfo& info) {
  Arena& arena = exec_.arena();
  kind_.reset();
  built_ = 0;
  info = {};
  arena.rewind(0);
  frame_ = VolumeFrame(volume);
  described_ = {volume.kind, volume.dims, volume.spacing, volume.origin, volume.axes, {},
                {},          {},          volume.labels,  volume.names,  {}};
  wishes_ = volume.sizes ? std::optional(size_wishes(volume)) : std::nullopt;
  size_bounds(parameters.sizes, described_);  // what cannot be read is said before the long work
  MaterialArray thinned;
  if (volume.kind == MeshVolume::Kind::labels && volume.materials() > max_block_materials) {
    thinned = volume.material.copy();
    info.thinned_voxels = thin_materials(volume.dims, thinned.own(), max_block_materials);
  }
  bricks_ = lay_out_bricks(exec_, volume.dims, frame_.relative_spacing(), kernel_from_string(parameters.kernel),
                           thinned.empty() ? volume.material : thinned);
  if (bricks_.bricks == 2)
    throw Error("one material only", "every voxel of the volume is of the same material",
                "choose others with `materials` or `isovalue`");
  if (volume.kind == MeshVolume::Kind::indicators) {
    const std::vector<std::uint16_t>& material = volume.material.numbers();
    fill_indicators(exec_, bricks_, material, volume.values, indicator_range(volume.dims, material, volume.values));
  } else if (volume.kind == MeshVolume::Kind::scalar) {
    const std::vector<float>& values = volume.values.at(0);
    float scale = 0;
    for (const float v : values) scale = std::max(scale, std::fabs(v));
    const Vec3f spacing(frame_.relative_spacing());
    const float slope = volume.levels.size() == 1 ? distance_slope(volume.dims, spacing, values, volume.levels[0]) : 0;
    info.ridge_voxels = fill_scalar(exec_, bricks_, values, volume.levels, scale > 0 ? scale : 1, slope);
  }
  area_ = boundary_area(exec_, bricks_);
  info.blocks = bricks_.blocks;
  mark_[0] = arena.mark();
  kind_ = volume.kind;
}

template <class Backend>
VolumeFacts MeshFields<Backend>::facts(const MeshParameters& parameters) {
  Arena& arena = exec_.arena();
  const FieldRecipe wanted = recipe(parameters);
  const std::size_t mark = arena.mark();
  VolumeFacts facts;
  facts.lattice_tiles = tiles_near(exec_, bricks_, wanted.lattice, wanted.reach).count();
  arena.rewind(mark);
  facts.bricks = bricks_.bricks;
  facts.boundary = area_;
  facts.spacing = wanted.lattice.spacing.x;
  return facts;
}

template <class Backend>
bool MeshFields<Backend>::drop_outdated(const MeshParameters& parameters) {
  built_ = std::min(built_, recipe_.alike(recipe(parameters)));
  if (built_ == field_stages) return false;
  exec_.arena().rewind(mark_[built_]);
  return true;
}

template <class Backend>
void MeshFields<Backend>::build(const MeshParameters& parameters, const TellStage& tell, MeshInfo& info) {
  static constexpr std::string_view name[] = {"tighten", "distance", "sizing", "embed"};
  static constexpr double fraction[] = {0.02, 0.05, 0.08, 0.12};
  Arena& arena = exec_.arena();
  recipe_ = recipe(parameters);
  bricks_.kernel = recipe_.kernel;
  while (built_ < field_stages) {
    arena.rewind(mark_[built_]);
    if (built_ != tighten_stage || kind_ == MeshVolume::Kind::labels) {
      auto stage = exec_.stage(name[built_]);
      tell(name[built_], fraction[built_], 0, 0);
      build_stage(FieldStage(built_), parameters, info);
    }
    mark_[++built_] = arena.mark();
  }
}

template <class Backend>
void MeshFields<Backend>::build_stage(FieldStage which, const MeshParameters& parameters, MeshInfo& info) {
  switch (which) {
    case tighten_stage: info.constrained_voxels = tighten(exec_, bricks_, recipe_.width, recipe_.stairs).held; break;
    case distance_stage: distance_ = distance_field(exec_, bricks_, recipe_.spacing, recipe_.reach); break;
    case sizing_stage: size_ = sizing_field(exec_, distance_, recipe_.rule, recipe_.bounds, wishes()); break;
    default:
      recipe_.cells_per_voxel = recipe(parameters).cells_per_voxel;  // now that the sizing field is known
      grid_ = embed_interfaces(exec_, bricks_, distance_, size_, recipe_.cells_per_voxel, recipe_.seeds_only);
      relate_interfaces(info);
      describe(info);
  }
}

template <class Backend>
void MeshFields<Backend>::relate_interfaces(MeshInfo& info) {
  table_ = make_junction_table(grid_.junctions, grid_.point_junction);
  info.junctions.clear();
  for (const Junction& j : table_.junctions) info.junctions.push_back(j.all());
  Arena& arena = exec_.arena();
  junction_ = arena.permanent_copy<Junction>(table_.junctions);
  related_start_ = arena.permanent_copy<std::uint32_t>(table_.start);
  related_ = arena.permanent_copy<std::uint32_t>(table_.related);
  order_ = arena.permanent_copy<std::uint8_t>(table_.order);
}

template <class Backend>
void MeshFields<Backend>::describe(MeshInfo& info) {
  info.smallest_size = size_.smallest;
  info.largest_size = size_.largest;
  info.field_bytes = bricks_.bytes() + distance_.bytes() + size_.bytes();
  info.embedding_bytes = grid_.bytes();
  info.embedding_cells = grid_.cells();
  info.surfaces = info.curves = 0;
  for (const Junction& j : grid_.junctions) ++(j.order() == 2 ? info.surfaces : info.curves);
  info.points = int(grid_.points.size());
  info.crowded_points = grid_.crowded_points;
  info.crowded_cells = grid_.crowded_cells;
  expected_[0] = info.points;
  for (const int order : {1, 2}) expected_[order] = expected_particles(exec_, seeds(order));
  info.expected_particles = expected_[0] + expected_[1] + expected_[2];
}

}  // namespace nacre
