// Nacre: streamlines that lie evenly on a surface.
#pragma once

#include <atomic>
#include <vector>

#include "compute/topology/surface_lines.hpp"

namespace nacre {

/// A streamline, in the direction of the flow, and the speed at each point.
struct EvenLine {
  std::vector<Vec3d> points;
  std::vector<float> speed;
};

/// Streamlines `spacing` (world units) apart, after B. Jobard and W. Lefer, Creating evenly-spaced streamlines of
/// arbitrary density (1997), on a surface: a new line begins straight across the flow, `spacing` beside a line that
/// there is, or where none is near. It goes both ways until it comes within half of `spacing` of another line, or
/// of itself; distances are those in space, between parts of the surface that face alike. Lines shorter than `spacing`
/// are left out. The same to the byte in every run. Throws Interrupted where `stop` is set.
std::vector<EvenLine> even_lines(const TangentField& field, double spacing, const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
