// Nacre: the built-in flows on analytic surfaces, by name.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/surface/surface.hpp"

namespace nacre {

struct SampleInfo {
  std::string name;  ///< what `make_sample` takes
  std::string help;  ///< one line
};

/// All built-in flow samples, in the order in which to list them.
std::vector<SampleInfo> samples();

/// Builds a sample: a closed manifold wound outward, with one 3-component point array `velocity` that is tangential to
/// the analytic surface. `delta-wing` is not closed: it is a sheet with an edge around it. Times run from 0 towards 1
/// and loop: after the last step comes the first. `detail` is about the number of triangle edges along the longest side
/// (0: the sample's default, 100k to 200k triangles); the surface and the flow do not depend on it. The geometry is
/// computed here, once; each `load` only computes the velocities, but for `pulse`, which moves, and whose velocity has
/// that of the surface in it. Throws Error for an unknown name (with the known
/// ones) or a detail outside of what the sample can resolve.
SurfaceSeries make_sample(const std::string& name, int detail = 0);

}  // namespace nacre
