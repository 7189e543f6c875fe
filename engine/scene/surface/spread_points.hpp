// Nacre: points spread evenly over a surface, for arrows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// A point of a triangle.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  Vec3f weights;  ///< of its corners
};

/// At most `count` points, none nearer to another than the room allows (blue noise by darts); the same for one seed.
/// None where the triangles have no area.
std::vector<SurfacePoint> spread_points(std::span<const Vec3d> points, std::span<const Triangle> triangles, int count,
                                        std::uint32_t seed);

/// Of all triangles; the points' unit, squared.
double surface_area(std::span<const Vec3d> points, std::span<const Triangle> triangles);

}  // namespace nacre
