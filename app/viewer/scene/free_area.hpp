// Nacre: the part of the window that no panel covers.
#pragma once

#include <algorithm>
#include <array>

namespace nacre {

/// Pixels from the left upper corner of the window.
struct FreeArea {
  int x = 0, y = 0, width = 0, height = 0;

  double aspect() const { return double(width) / double(height > 0 ? height : 1); }
};

/// A position in the window as cameras count: from (-1, -1), left below, to (1, 1) over the area.
inline std::array<double, 2> position_in(const FreeArea& area, double x, double y) {
  return {2 * (x - area.x) / std::max(1, area.width) - 1, 1 - 2 * (y - area.y) / std::max(1, area.height)};
}

}  // namespace nacre
