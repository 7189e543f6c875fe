// Nacre: what has to run again when knobs of the mesh have changed.
#include "compute/pipeline/mesh_rerun.hpp"

#include <tuple>

#include "compute/pipeline/mesh_choices.hpp"

namespace nacre {
namespace {

auto of_fields(const MeshParameters& p) {
  return std::tie(p.kernel, p.tighten, p.stairs, p.epsilon, p.delta, p.min_size, p.max_size, p.sizes, p.curvature,
                  p.max_deviation, p.subcells, p.projection);
}

auto of_relax(const MeshParameters& p) {
  return std::tie(p.solver, p.iterations, p.stagnation, p.ideal_energy, p.add_below, p.delete_above, p.control_every,
                  p.seeds, p.particles, p.seed);
}

auto of_tree(const MeshParameters& p) { return std::tie(p.theta, p.step, p.momentum, p.coarse_iterations); }

auto of_triangles(const MeshParameters& p) { return std::tie(p.smooth, p.remesh, p.triangles); }

}  // namespace

MeshRerun mesh_rerun(const MeshParameters& asked_before, const MeshParameters& asked_after) {
  const MeshParameters before = at_quality(asked_before), after = at_quality(asked_after);
  const auto is_draft = [](const MeshParameters& p) { return quality_from_string(p.quality) == QualityLevel::draft; };
  if (of_fields(before) != of_fields(after) || is_draft(before) != is_draft(after)) return MeshRerun::fields;
  if (of_relax(before) != of_relax(after)) return MeshRerun::relax;
  const bool tree = after.solver == to_string(Solver::tree);
  if (tree ? of_tree(before) != of_tree(after) : before.by_density != after.by_density) return MeshRerun::relax;
  return of_triangles(before) != of_triangles(after) ? MeshRerun::triangulate : MeshRerun::nothing;
}

}  // namespace nacre
