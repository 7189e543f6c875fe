// Nacre: the clip plane that the look asks for.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "engine/render/view.hpp"
#include "engine/scene/settings.hpp"

namespace nacre {

/// Across an axis of the world at a share of the bounding box of `corners`; none where the look asks for none.
inline std::optional<ClipPlane> clip_plane(const Look& look, std::span<const Vec3d> corners) {
  const int axis = look.clip == "x" ? 0 : look.clip == "y" ? 1 : look.clip == "z" ? 2 : -1;
  if (axis < 0 || corners.empty()) return {};
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  for (const Vec3d& p : corners) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
  const double at = low + look.clip_at * (high - low), sign = look.clip_back ? -1 : 1;
  ClipPlane plane{Vec3d(0), sign * at};
  plane.normal[axis] = sign;
  return plane;
}

}  // namespace nacre
