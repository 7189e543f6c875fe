// Nacre: what the mouse does to a camera. No OpenGL here.
#pragma once

#include "compute/raycast/camera.hpp"

namespace nacre {

// Places on the picture are (x, y) from (-1, -1), left below, to (1, 1); movements are differences of those. `aspect`
// is width / height.

/// The point under (x, y) in the plane through the target that faces the camera.
Vec3d point_under(const Camera& camera, double x, double y, double aspect);

/// The ray through (x, y), unit; it begins at the eye (in its plane where the camera is orthographic).
struct ViewRay {
  Vec3d from, along;
};
ViewRay ray_under(const Camera& camera, double x, double y, double aspect);

/// Turntable: a movement across the whole picture turns by half a circle, about `up` and about the axis across. It
/// stops a degree short of looking along `up`.
Camera turn_table(const Camera& camera, double dx, double dy);

/// Trackball: the same without a fixed up, so that any orientation can be reached.
Camera turn_ball(const Camera& camera, double dx, double dy);

/// Moves with the scene: what was under the cursor, at the target's depth, stays under it.
Camera pan(const Camera& camera, double dx, double dy, double aspect);

/// Brings everything nearer (factor < 1) or farther, and keeps what is under (x, y), at the target's depth, where it
/// is.
Camera dolly(const Camera& camera, double factor, double x, double y, double aspect);

}  // namespace nacre
