// Nacre: vectors between two shapes of the same triangles, and how much one shape stretches the other.
#pragma once

#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Vectors on the points of one shape as they are on another shape of the same triangles: a triangle maps its two edges
/// and its unit normal onto those of the other (the deformation gradient F), a point takes the mean of its triangles by
/// their area. A rigid motion turns vectors exactly. Curves along the vectors become curves along the vectors, so that
/// what flows on one shape flows on the other. Zero where no triangle has area.
void transfer_vectors(std::span<const Vec3d> from, std::span<const Vec3d> to, std::span<const Triangle> triangles,
                      std::span<const Vec3f> vectors, std::span<Vec3f> result);

/// The share of the area of `from` where the map to `to` stretches or shortens some direction by more than `limit`: a
/// singular value of F above `limit` or below its inverse.
double distorted_share(std::span<const Vec3d> from, std::span<const Vec3d> to, std::span<const Triangle> triangles,
                       double limit);

}  // namespace nacre
