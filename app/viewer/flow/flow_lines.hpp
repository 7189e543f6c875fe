// Nacre: lines and marks over a flow, as the worker finds them. No OpenGL here.
#pragma once

#include <cstddef>

#include "engine/run/flow_skeleton.hpp"

namespace nacre {

/// Of one time, without the shape of the surface; what is not wanted is empty.
struct FlowLines {
  FlowSkeleton skeleton;
  FlowStreamlines streamlines;

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
