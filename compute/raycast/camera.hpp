// Nacre: a camera, and the rays through its pixels.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "compute/grid/vec.hpp"

namespace nacre {

/// Where the picture is taken from, in world coordinates. `height` is the visible height at the target: the field of
/// view of a perspective camera follows from its distance, an orthographic one has just that.
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
    const Vec3d f = forward();  // looking along `up`: any direction across will do
    return normalized(cross(f, std::fabs(f.x) < 0.9 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
  }
};

/// What of a picture's right border nothing may lie under, such as a legend: from `left` to the border, from `top` to
/// `bottom`, in shares of its width and height from the left upper corner. As it stands: nothing.
struct KeptFree {
  double left = 1, top = 0, bottom = 1;
};

/// A camera that sees all `points` from `view`: "iso", "+x", "-x", "+y", "-y", "+z" or "-z" (the side it stands on; z
/// is up, y for the two z views). They fill the picture, or, where they would reach into what is kept free, what is to
/// the left of it. Throws Error for any other word.
Camera fit_camera(const std::string& view, std::span<const Vec3d> points, int width, int height,
                  const KeptFree& kept = {});

/// The same from where `from` looks, in its projection.
Camera fit_camera(const Camera& from, std::span<const Vec3d> points, int width, int height, const KeptFree& kept = {});

/// The same for the corners of a box.
Camera fit_camera(const std::string& view, const Vec3d& lower, const Vec3d& upper, int width, int height);

/// Turns the camera about the vertical axis through its target.
Camera orbit(const Camera& camera, double degrees);

}  // namespace nacre
