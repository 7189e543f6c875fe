// Nacre: points of a body-centred lattice that grows coarser with the distance from given points.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Longest edges wanted at some positions, world units, one per position.
using EdgeLength = std::function<std::vector<float>(std::span<const Vec3d>)>;

/// The corners and centres of the leaves of an octree around `points`. A leaf that holds point i has edges of about
/// size[i] (> 0; between 0.7 and 1.4 times that); from there on edges double at most every other leaf. Where
/// `edge_length` is given leaves are no larger than 1.5 times what it says, but never finer than the finest at a point.
/// In an even region the points are a body-centred cubic lattice, whose Delaunay cells have dihedral angles of 60 and
/// 90 degrees. Points are off the lattice by up to 0.0005 of the finest edge: ties would cost Delaunay exact
/// arithmetic. Ascending by (z, y, x). Throws Error where that would be more than 200 million leaves.
std::vector<Vec3d> graded_lattice(std::span<const Vec3d> points, std::span<const double> size,
                                  const EdgeLength& edge_length);

}  // namespace nacre
