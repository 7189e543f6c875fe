// Nacre: what the mouse does to a camera. No OpenGL here.
#pragma once

#include "compute/raycast/camera.hpp"

namespace nacre {

// Positions on the picture are (x, y) from (-1, -1), lower left, to (1, 1); movements are differences of positions.
// `aspect` is width / height.

/// The point under (x, y) in the plane through the target that faces the camera.
Vec3d point_under(const Camera& camera, double x, double y, double aspect);

/// The ray through (x, y), unit; it begins at the eye (in the eye's plane if the camera is orthographic).
struct ViewRay {
  Vec3d from, along;
};
ViewRay ray_under(const Camera& camera, double x, double y, double aspect);

/// Turntable: a movement across the whole picture turns the camera by half a circle, about `up` and about the
/// horizontal axis. It stops a degree short of looking along `up`.
Camera turn_table(const Camera& camera, double dx, double dy);

/// Trackball: the same without a fixed up direction, so that any orientation can be reached.
Camera turn_ball(const Camera& camera, double dx, double dy);

/// Moves with the scene: what was under the cursor, at the depth of the target, stays under it.
Camera pan(const Camera& camera, double dx, double dy, double aspect);

/// Moves everything nearer (factor < 1) or farther; what is under (x, y), at the depth of the target, stays in place.
Camera dolly(const Camera& camera, double factor, double x, double y, double aspect);

/// The camera that looks at the plane through `point` instead of its target: the picture is the same, but
/// `dolly` and `pan` move what is there with the cursor. For a perspective camera `point` must lie before the eye.
Camera look_at_depth(const Camera& camera, const Vec3d& point);

/// Goes to a point of a surface until the picture there is `height` high; no farther away than it is. `back`: unit,
/// from the point to the eye; where that is along the surface with this `normal` (unit, or 0), the camera looks from
/// the side of `back`, but from more in front.
Camera approach(const Camera& camera, const Vec3d& point, const Vec3d& back, const Vec3d& normal, double height);

/// `factor` as far as `dolly` may go in a scene of this `extent` (world; > 0): the picture's height at the target stays
/// between a ten-thousandth and ten times that. A camera beyond these limits may come back.
double limited_zoom(const Camera& camera, double factor, double extent);

}  // namespace nacre
