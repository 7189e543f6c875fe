// Nacre: what the knobs say of a picture: background and camera.
#pragma once

#include <array>
#include <span>
#include <string>

#include "compute/raycast/camera.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// "#rrggbb" as 0..1. Throws Error.
std::array<float, 3> parse_color(const std::string& text);

/// Throws Error where `camera` or `background` has no valid value; a camera file is not opened.
void check_picture_settings(const Settings& settings);

/// The camera of the settings: a view that sees all `corners`, beside the legend where the picture has one; or what its
/// JSON file says. Throws Error.
Camera read_camera(const Settings& settings, std::span<const Vec3d> corners, bool legend);

/// The session's own camera, else that of its settings. Throws Error.
Camera read_camera(const Session& session, std::span<const Vec3d> corners, bool legend);

}  // namespace nacre
