// Nacre: the view of a frame, from the session.
#pragma once

#include <array>
#include <span>

#include "engine/render/view.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// Camera (`turned` by so many degrees by the knob `orbit`), light and clip planes, for a scene with these `corners`
/// (world) on width x height pixels.
View scene_view(const Session& session, std::span<const Vec3d> corners, double turned, int width, int height);

/// Of their bounding box; 0: there are none.
double diameter_of(std::span<const Vec3d> points);

/// Behind the scene, encoded.
std::array<float, 4> background_of(const Settings& settings);

}  // namespace nacre
