// Nacre: a camera, and the rays through its pixels.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// The view of a picture, in world coordinates. `height` is the visible height at the target: a perspective camera gets
/// its field of view from it and its distance, an orthographic camera has exactly this height.
struct Camera {
  Vec3d eye{0, 0, 1};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  double height = 2;
  bool orthographic = false;

  bool operator==(const Camera&) const = default;

  Vec3d forward() const { return normalized(target - eye); }
  Vec3d right() const {
    const Vec3d r = cross(forward(), up);
    if (length(r) > 1e-9 * length(up)) return normalized(r);
    const Vec3d f = forward();  // looking along `up`: any perpendicular direction is good
    return normalized(cross(f, std::fabs(f.x) < 0.9 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
  }
};

/// An area at the right border of a picture that must stay free, for example for a legend: from `left` to the border
/// and from `top` to `bottom`, as fractions of width and height from the upper left corner. By default it is empty.
struct KeptFree {
  double left = 1, top = 0, bottom = 1;
};

/// A camera that sees all `points` from `view`: "iso", "+x", "-x", "+y", "-y", "+z" or "-z" (the side it stands on; z
/// is up, y for the two z views). The points fill the picture or, if they would reach into the area that is kept free,
/// the part to the left of it. Throws Error for any other name.
Camera fit_camera(const std::string& view, std::span<const Vec3d> points, int width, int height,
                  const KeptFree& kept = {});

/// The same, with the direction and projection of the camera `from`.
Camera fit_camera(const Camera& from, std::span<const Vec3d> points, int width, int height, const KeptFree& kept = {});

/// The same for the corners of a box.
Camera fit_camera(const std::string& view, const Vec3d& lower, const Vec3d& upper, int width, int height);

/// Of `points`, those that decide what `fit_camera(from, ...)` gives for them and any others; `lower`, `upper`: the box
/// around all of them.
std::vector<Vec3d> outermost(const Camera& from, std::span<const Vec3d> points, const Vec3d& lower, const Vec3d& upper);

/// The direction of such a view.
Camera preset_camera(const std::string& view);

/// Turns the camera about the vertical axis through its target.
Camera orbit(const Camera& camera, double degrees);

/// What is drawn of triangles that face away from the camera.
enum class BackFaces {
  shown,    ///< the same as of their fronts
  neutral,  ///< grey
  hidden    ///< nothing: what lies behind them is seen
};

}  // namespace nacre
