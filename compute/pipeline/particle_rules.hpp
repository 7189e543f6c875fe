// Nacre: how the knobs become parameters of the solvers: steps, population control, capacity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "compute/particles/tree_solver.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

TreeRule tree_rule(const MeshParameters& parameters);

/// For particles of a junction order. On curves thresholds are wider, since a curve's particle has two neighbours only.
PopulationRule population_rule(const MeshParameters& parameters, int order);

/// Capacity for particles where `expected` are seeded. Crowded regions relax to fewer, holes fill: half as many
/// again has always been enough.
double particle_capacity(double expected);

/// What the solver and its temporaries take for so many particles, bytes.
double solver_bytes(std::int64_t capacity, std::int64_t interfaces, const MeshParameters& parameters);

/// The capacity for `expected` particles on `interfaces` interfaces. Throws Error where `free` bytes of `device` are
/// too few for that; `why` goes before their number.
std::int64_t require_room_for(double expected, std::int64_t interfaces, std::size_t free, const Device& device,
                              const MeshParameters& parameters, const std::string& why);

}  // namespace nacre
