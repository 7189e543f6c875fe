// Nacre: where the particles of a volume's junctions begin.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/particles/marching_cubes_seeds.hpp"
#include "compute/pipeline/mesh_choices.hpp"
#include "compute/pipeline/mesh_fields.hpp"

namespace nacre {

/// Puts a particle at every junction point, where it stays, in an empty set.
template <class Backend>
void put_points(const MeshFields<Backend>& fields, ParticleSet& set, Array<Float4>& velocity) {
  const InterfaceGrid& grid = fields.grid();
  const std::size_t n = grid.points.size();
  if (n == 0) return;
  std::vector<std::uint32_t> interface;
  for (const Junction& j : grid.point_junction) interface.push_back(*fields.table().find(j));
  const std::vector<Float4> zero(n, Float4{0, 0, 0, 0});
  set.position.upload(grid.points);
  set.direction.upload(zero);
  set.interface.upload(interface);
  velocity.upload(zero);
  set.count = std::int64_t(n);
}

/// Puts seeds on the curves (order 1) or the surfaces (2), as the sizing field asks for or `parameters.particles` says,
/// behind the particles of a set; returns how many. Throws Error where they do not fit.
template <class Backend>
std::int64_t seed_order(Executor<Backend>& exec, const MeshFields<Backend>& fields, const MeshParameters& parameters,
                        int order, ParticleSet& set, Array<Float4>& velocity) {
  Arena::Scope scope(exec.arena());
  const auto put = [&](const auto& seeds) {
    double scale = 1;
    if (order == 2 && parameters.particles > 0)
      scale = parameters.particles / std::max(1.0, expected_particles(exec, seeds));
    return seed_particles(exec, seeds, scale, parameters.seed, set, velocity);
  };
  if (order == 2 && MeshChoices(parameters).seeds == SeedOrigin::marching_cubes)
    return put(marching_cubes(exec, fields.bricks(), fields.size(), fields.grid().junction));
  return put(fields.seeds(order));
}

}  // namespace nacre
