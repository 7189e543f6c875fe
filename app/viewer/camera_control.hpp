// Nacre: the camera of the viewer: what mouse and menus do to it.
#pragma once

#include <array>
#include <string>

#include "compute/raycast/camera.hpp"

namespace nacre {

/// The part of the window that no panel covers, pixels from the left upper corner.
struct FreeArea {
  int x = 0, y = 0, width = 0, height = 0;

  double aspect() const { return double(width) / double(height > 0 ? height : 1); }
};

/// A place of the window as cameras count: from (-1, -1) to (1, 1) over the area.
std::array<double, 2> place_in(const FreeArea& area, double x, double y);

/// Moves the camera by what the mouse has done since the last frame, where no panel wants it. `turning`: turntable or
/// trackball. Between Interface::begin and end.
void move_camera(Camera& camera, const std::string& turning, const FreeArea& area);

}  // namespace nacre
