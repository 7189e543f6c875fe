// Nacre: the camera of the viewer: what mouse and menus do to it.
#pragma once

#include <functional>
#include <optional>

#include "app/viewer/scene/free_area.hpp"
#include "compute/raycast/camera.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// What a ray (unit `along`) meets first; none: nothing.
using FindSurface = std::function<std::optional<Vec3d>(const Vec3d& from, const Vec3d& along)>;

/// Moves the camera by what the mouse has done since the last frame, where no panel wants it. The wheel zooms to what
/// `find` meets under the cursor, within limits that `extent` sets (of the scene, world; 0: none). Between
/// ImGuiLayer::begin and end.
void move_camera(Camera& camera, Turning turning, const FreeArea& area, double extent, const FindSurface& find);

}  // namespace nacre
