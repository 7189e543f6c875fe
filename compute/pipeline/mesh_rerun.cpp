// Nacre: what has to run again when knobs of the mesh have changed.
#include "compute/pipeline/mesh_rerun.hpp"

#include <tuple>

namespace nacre {
namespace {

auto of_fields(const MeshParameters& p) {
  return std::tie(p.kernel, p.tighten, p.epsilon, p.delta, p.min_size, p.max_size, p.curvature, p.subcells);
}

auto of_relax(const MeshParameters& p) {
  return std::tie(p.solver, p.iterations, p.stagnation, p.ideal_energy, p.add_below, p.delete_above, p.control_every,
                  p.particles, p.seed);
}

auto of_tree(const MeshParameters& p) { return std::tie(p.theta, p.step, p.momentum); }

// Mending lets particles close up by the tree, whichever solver has moved them, with a momentum of its own.
auto of_mending(const MeshParameters& p) { return std::tie(p.theta, p.step); }

}  // namespace

MeshRerun mesh_rerun(const MeshParameters& before, const MeshParameters& after) {
  if (of_fields(before) != of_fields(after)) return MeshRerun::fields;
  if (of_relax(before) != of_relax(after)) return MeshRerun::relax;
  const bool tree = after.solver == "tree";
  if (tree ? of_tree(before) != of_tree(after) : before.by_density != after.by_density) return MeshRerun::relax;
  if (before.mend != after.mend) return MeshRerun::triangulate;
  if (!tree && after.mend > 0 && of_mending(before) != of_mending(after)) return MeshRerun::triangulate;
  return MeshRerun::nothing;
}

}  // namespace nacre
