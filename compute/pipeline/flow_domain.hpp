// Nacre: where the grid of a flow run lies, and how much memory it will take.
#pragma once

#include "compute/device/arena.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// The closest-point grid's frame in the world: cell = (p - origin) / cell_size.
struct FlowDomain {
  Vec3d origin{};
  double cell_size = 1;  ///< of the closest-point grid
  Int3 bricks{};
  Int3 cells{};       ///< of an octree's cube
  Int3 extent{};      ///< closest-point cells of the bounding box, without the margin
  int margin = 0;     ///< cells beside it
  double radius = 0;  ///< of the band, in cells

  Vec3d to_grid(const Vec3d& p) const { return (p - origin) / cell_size; }
  Vec3d to_world(const Vec3d& g) const { return origin + g * cell_size; }
};

/// Radius of the band that the stencils need: a WENO4 stencil reaches 2 cells along every axis from its point, and a
/// trial point lies up to one cell off the surface: 2 sqrt 3 + 1.
inline constexpr double stencil_radius = 4.47;

/// Nothing for streaks. Throws Error where a pattern cannot be made with these parameters: on an octree, with cells too
/// large for its spacing, in a band too narrow, or stretched more than its stencils allow.
void require_pattern(const FlowParameters& parameters);

/// Throws Error where the resolution is out of the key range.
FlowDomain make_domain(const FlowMesh& mesh, const FlowParameters& parameters);

/// Radius of an octree's band: a cell that a linear interpolation on the surface asks lies at most sqrt 3 off it, and a
/// path may drift by half a cell before it is noticed.
inline constexpr double octree_radius = 2.24;

/// The cube of `resolution` cells per axis around the surface, which leaves room for the band on all sides. Returns the
/// levels of the octree that covers it (of bricks of 8^3 cells). Throws Error where the resolution is out of the key
/// range. `sharers`: of a mesh that is shared; then it is collective.
int make_octree_domain(const FlowMesh& mesh, const FlowParameters& parameters, FlowDomain& domain,
                       Ranks* sharers = nullptr);
void require_octree_memory(const FlowMesh& mesh, const FlowParameters& parameters, const Arena& arena);

/// Throws Error, naming the largest resolution that fits, where the estimate is over the room in `arena`.
void require_memory(const FlowMesh& mesh, const FlowParameters& parameters, const Arena& arena);

}  // namespace nacre
