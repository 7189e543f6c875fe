// Nacre: the plane that cuts a scene, from the knobs of the view.
#pragma once

#include <optional>
#include <span>

#include "engine/render/view.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// Across the axis `view.clip`, at share `view.clip_at` of the box around `corners` (world); none where that says so.
std::optional<ClipPlane> clip_plane(const ViewSettings& view, std::span<const Vec3d> corners);

}  // namespace nacre
