// Nacre: the convex hull of a few points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Triangles around the points, counter-clockwise seen from outside; points within are left out. Empty where the points
/// lie in a plane, or so nearly that rounding decides. Takes the square of their number.
std::vector<Triangle> small_hull(std::span<const Vec3d> points);

}  // namespace nacre
