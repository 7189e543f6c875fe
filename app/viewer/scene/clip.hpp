// Nacre: the plane that cuts a scene, from the knobs of the look.
#pragma once

#include <optional>
#include <span>

#include "engine/render/view.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// Across the axis `look.clip`, at share `look.clip_at` of the box around `corners` (world); none where that says so.
std::optional<ClipPlane> clip_plane(const ViewSettings& look, std::span<const Vec3d> corners);

}  // namespace nacre
