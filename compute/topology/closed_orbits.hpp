// Nacre: closed orbits of the flow, which others wind towards or away from.
#pragma once

#include <span>
#include <vector>

#include "compute/topology/separation_lines.hpp"
#include "compute/topology/surface_lines.hpp"

namespace nacre {

struct ClosedOrbit {
  std::vector<Vec3d> points;  ///< world units; the last is the first again, up to the error of the steps
  bool attracting = true;     ///< what is beside it comes nearer with the flow; else it does so against the flow
  double multiplier = 0;      ///< by which the distance of what is beside it shrinks in a round, that way; in 0..1
};

/// Found by lines that circle: `separatrices`, lines from sources, sinks and foci, and from the middle of each line of
/// separation (with the flow) or attachment (against it). Where such a line passes one triangle again and again, the
/// points at which it crosses a section through that triangle converge to that of the orbit, which Newton's method on
/// the Poincare map then finds. Orbits around a centre, of which each is closed, are none: nothing winds towards them.
/// So are those that nothing above leads to. The same to the byte in every run.
std::vector<ClosedOrbit> closed_orbits(const TangentField& field, std::span<const CriticalPoint> points,
                                       std::span<const SurfaceLine> separatrices,
                                       std::span<const SeparationLine> separation);

}  // namespace nacre
