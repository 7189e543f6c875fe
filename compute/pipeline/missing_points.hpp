// Nacre: junction points that were not found, where the curves that end there tell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/embedding/junction_table.hpp"
#include "compute/meshing/curve_links.hpp"
#include "compute/pipeline/host_particles.hpp"
#include "compute/pipeline/movable_particles.hpp"

namespace nacre {

/// What stars ask of particles, beyond what these hold.
struct StarInput {
  std::vector<Junction> junction;
  std::vector<JunctionGradients> gradient;

  StarParticles of(const HostParticles& particles) const {
    return {particles.position, particles.direction, junction, gradient};
  }
};
StarInput star_input(MovableParticles& fields, const HostParticles& particles, const JunctionTable& table);

/// A place where curves of four materials end, and no point is.
struct CurveMeeting {
  std::uint32_t junction = 0;       ///< of the four, in the table
  std::vector<std::uint32_t> ends;  ///< the particles at which the curves end, ascending
  Vec3d middle;                     ///< of these
};

/// Where three or four of the curves that meet at a point of the table's kinds end within a size of each other.
std::vector<CurveMeeting> curve_meetings(const StarParticles& particles, std::span<const CurveNode> nodes,
                                         const JunctionTable& table);

/// Puts a particle onto the point at each such place, instead of the last one of a curve. Those of the other curves
/// that would be too close to it go. Returns how many points there are more.
std::size_t put_missing_points(MovableParticles& particles, const JunctionTable& table, const VolumeFrame& frame);

}  // namespace nacre
