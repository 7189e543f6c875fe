// Nacre: the plane that cuts a scene.
#include "app/viewer/scene/clip.hpp"

#include <algorithm>

namespace nacre {

std::optional<ClipPlane> clip_plane(const ViewSettings& view, std::span<const Vec3d> corners) {
  const int axis = int(view.clip) - 1;
  if (axis < 0 || corners.empty()) return {};
  double low = corners.front()[axis], high = low;
  for (const Vec3d& p : corners) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
  const double position = low + view.clip_at * (high - low), side = view.clip_back ? -1 : 1;
  ClipPlane plane{{0, 0, 0}, side * position};
  plane.normal[axis] = side;
  return plane;
}

}  // namespace nacre
