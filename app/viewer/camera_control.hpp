// Nacre: the camera of the viewer: what mouse and menus do to it.
#pragma once

#include <span>
#include <string>

#include "compute/raycast/camera.hpp"

namespace nacre {

/// Moves the camera by what the mouse has done since the last frame, where no panel wants it. `turning`: turntable or
/// trackball. Between Interface::begin and end.
void move_camera(Camera& camera, const std::string& turning);

/// All of `points` from a named view; perspective or orthographic as before.
void look_from(Camera& camera, const std::string& view, std::span<const Vec3d> points, int width, int height);

/// All of `points` from where the camera looks now.
void fit(Camera& camera, std::span<const Vec3d> points);

}  // namespace nacre
