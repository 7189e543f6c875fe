// Nacre: triangles whose points at one position are one point.
#pragma once

#include <vector>

#include "engine/scene/surface/prepare.hpp"

namespace nacre {

/// The triangles with one number for all points at one position; each sheet by itself.
std::vector<Triangle> welded_triangles(const PreparedSurface& surface);

}  // namespace nacre
