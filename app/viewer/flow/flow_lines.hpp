// Nacre: lines and marks over a flow, as the worker finds them. No OpenGL here.
#pragma once

#include <cstddef>
#include <memory>

#include "engine/run/flow_skeleton.hpp"
#include "engine/run/flow_tracks.hpp"

namespace nacre {

/// Of one time, without the shape of the surface; what is not wanted is empty.
struct FlowLines {
  double time = 0;
  FlowSkeleton skeleton;
  FlowStreamlines streamlines;
  std::shared_ptr<const FlowTracks> tracks;  ///< of all times; null: none

  std::size_t bytes() const {
    std::size_t sum = skeleton.topology.points.size() * sizeof(CriticalPoint);
    for (const SurfaceLine& line : skeleton.separatrices)
      sum += line.points.size() * (sizeof(Vec3d) + sizeof(std::uint32_t));
    for (const SeparationLine& line : skeleton.separation) sum += line.points.size() * sizeof(Vec3d);
    for (const ClosedOrbit& orbit : skeleton.orbits) sum += orbit.points.size() * sizeof(Vec3d);
    for (const EvenLine& line : streamlines.lines) sum += line.points.size() * (sizeof(Vec3d) + sizeof(float));
    return sum;
  }
};

}  // namespace nacre
