// Nacre: the camera of the viewer: what mouse and menus do to it.
#pragma once

#include <string>

#include "app/viewer/scene/free_area.hpp"
#include "compute/raycast/camera.hpp"

namespace nacre {

/// Moves the camera by what the mouse has done since the last frame, where no panel wants it. `turning`: turntable or
/// trackball. Between ImGuiLayer::begin and end.
void move_camera(Camera& camera, const std::string& turning, const FreeArea& area);

}  // namespace nacre
