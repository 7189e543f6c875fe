// Nacre: which points are near some of them.
#pragma once

#include <cstdint>
#include <span>

#include "compute/math/vec.hpp"

namespace nacre {

/// Marks the points that are no farther than `reach` times size[i] from point i, for each i in `some`. Takes as long as
/// a glance at every point where these are few. In parallel.
void mark_near(std::span<const Vec3d> points, std::span<const std::uint32_t> some, std::span<const double> size,
               double reach, std::span<std::uint8_t> marks);

}  // namespace nacre
