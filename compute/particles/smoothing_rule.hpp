// Nacre: how particles move within the rings of triangles around them.
#pragma once

#include <cstdint>

namespace nacre {

/// How particles move while the triangles stay.
struct SmoothingRule {
  int turns = 6;            ///< simultaneous steps in a row; even: of two, the second ends on the interface
  std::uint32_t shake = 0;  ///< not 0: the first of them goes anywhere, by this seed
};

}  // namespace nacre
