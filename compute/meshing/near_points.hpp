// Nacre: which points are near some of them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "compute/math/vec.hpp"

namespace nacre {

/// For each point that is no farther than `reach` times size[i] from point i, for some i in `some`: calls
/// visit(point, all such i), in parallel. Takes as long as a glance at every point where these are few.
void for_points_near(std::span<const Vec3d> points, std::span<const std::uint32_t> some, std::span<const double> size,
                     double reach, const std::function<void(std::uint32_t, std::span<const std::uint32_t>)>& visit);

/// Marks the points that are no farther than `reach` times size[i] from point i, for each i in `some`. In parallel.
void mark_near(std::span<const Vec3d> points, std::span<const std::uint32_t> some, std::span<const double> size,
               double reach, std::span<std::uint8_t> marks);

}  // namespace nacre
