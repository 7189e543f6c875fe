// Nacre: what happens to the shape of a surface over the steps of a series.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Looks at the shapes of all steps of a series that moves, and fills `series.motion` in. A step whose shape cannot be
/// true is left out of the series, with a sentence to `warn`: a surface that vanishes (no triangles, no extent, points
/// that are not finite), one that is ten times as large or small as in the step before (another unit), one that is
/// turned inside out. Throws Error where no step is left; Interrupted where `stop` is set.
SurfaceSeries examine_motion(SurfaceSeries series, const std::function<void(const std::string&)>& warn,
                             const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
