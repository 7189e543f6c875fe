// Nacre: triangles whose corners are named by keys become triangles with point indices.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

using KeyedTriangle = std::array<std::uint64_t, 3>;

struct Welded {
  std::vector<std::uint64_t> keys;  ///< the distinct keys, sorted: point i is the one of `keys[i]`
  std::vector<Triangle> triangles;
};

/// Gives each distinct key one point index. The order of the triangles is kept.
Welded weld(const std::vector<KeyedTriangle>& corners);

}  // namespace nacre
