// Nacre: what dragging does to a clip plane in the view. No OpenGL and no Dear ImGui here.
#pragma once

#include <array>
#include <optional>

#include "app/viewer/scene/clip.hpp"
#include "app/viewer/scene/free_area.hpp"
#include "compute/raycast/camera.hpp"
#include "engine/render/camera_motion.hpp"

namespace nacre {

/// A camera and the part of the window that its picture fills. Pixels are those of the window.
struct PictureArea {
  Camera camera;
  FreeArea area;

  /// Where a point is seen; none behind the eye.
  std::optional<std::array<double, 2>> pixel_of(const Vec3d& point) const;
  ViewRay ray_through(double x, double y) const;
  /// How long a pixel is at a point.
  double pixel_size(const Vec3d& point) const;
};

/// The plane moved along its normal until its point is seen as near as possible to the pixel (x, y), but not out of the
/// box. Where the normal is seen nearly end on, up is away from the eye.
WorldPlane pushed_to(const WorldPlane& plane, const BoxCorners& box, const PictureArea& picture, double x, double y);

/// The plane turned about its point until the tip of an arrow of that length along its normal is seen at the pixel
/// (x, y), or as near as possible. The tip stays on the side of the point, nearer or farther, that it is on.
WorldPlane turned_to(const WorldPlane& plane, double arrow, const PictureArea& picture, double x, double y);

/// Where the handle of a plane is: its point, or the middle of its outline where the point is outside the box; none
/// where the plane misses the box.
std::optional<Vec3d> handle_of(const WorldPlane& plane, const BoxCorners& box);

}  // namespace nacre
