// Nacre: what the mouse does to a camera.
#include "engine/render/camera_motion.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

constexpr double pi = 3.14159265358979323846;

/// `v` turned about the unit vector `axis`.
Vec3d turned(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

}  // namespace

Vec3d point_under(const Camera& camera, double x, double y, double aspect) {
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  return camera.target + (right * (x * aspect) + up * y) * (0.5 * camera.height);
}

ViewRay ray_under(const Camera& camera, double x, double y, double aspect) {
  const Vec3d point = point_under(camera, x, y, aspect);
  if (camera.orthographic) return {point - (camera.target - camera.eye), camera.forward()};
  return {camera.eye, normalized(point - camera.eye)};
}

Camera turn_table(const Camera& camera, double dx, double dy) {
  const Vec3d up = normalized(camera.up), right = camera.right();
  Vec3d arm = camera.eye - camera.target;
  const double above = std::asin(std::clamp(dot(normalized(arm), up), -1.0, 1.0));
  const double limit = pi / 2 - pi / 180;
  // Moving down lifts the eye. If it is beyond the limit already (a view from the top), it may only come back.
  const double lifted = std::clamp(above - dy * pi / 2, std::min(-limit, above), std::max(limit, above));
  arm = turned(arm, right, -(lifted - above));
  Camera moved = camera;
  moved.eye = camera.target + turned(arm, up, -dx * pi / 2);
  return moved;
}

Camera turn_ball(const Camera& camera, double dx, double dy) {
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  Vec3d arm = turned(camera.eye - camera.target, right, dy * pi / 2);
  const Vec3d lifted_up = turned(up, right, dy * pi / 2);
  Camera moved = camera;
  moved.eye = camera.target + turned(arm, lifted_up, -dx * pi / 2);
  moved.up = lifted_up;
  return moved;
}

Camera pan(const Camera& camera, double dx, double dy, double aspect) {
  const Vec3d shift = camera.target - point_under(camera, dx, dy, aspect);
  Camera moved = camera;
  moved.eye += shift;
  moved.target += shift;
  return moved;
}

Camera dolly(const Camera& camera, double factor, double x, double y, double aspect) {
  const Vec3d fixed = point_under(camera, x, y, aspect);
  Camera moved = camera;
  moved.eye = fixed + (camera.eye - fixed) * factor;
  moved.target = fixed + (camera.target - fixed) * factor;
  moved.height = camera.height * factor;
  return moved;
}

Camera look_at_depth(const Camera& camera, const Vec3d& point) {
  const Vec3d forward = camera.forward();
  const double before = length(camera.target - camera.eye), depth = dot(point - camera.eye, forward);
  Camera moved = camera;
  if (camera.orthographic) {
    const Vec3d shift = forward * (depth - before);
    moved.eye += shift;
    moved.target += shift;
  } else if (depth > 0) {
    moved.target = camera.eye + forward * depth;
    moved.height = camera.height * (depth / before);
  }
  return moved;
}

Camera approach(const Camera& camera, const Vec3d& point, const Vec3d& back, const Vec3d& normal, double height) {
  const double facing = dot(normal, back);
  const bool along = length(normal) > 0 && std::fabs(facing) < 0.3;
  const Vec3d from = along ? normalized(back + normal * (facing < 0 ? -0.6 : 0.6)) : back;
  const double nearer = std::min(1.0, height / camera.height);
  Camera moved = camera;
  moved.target = point;
  moved.eye = point + from * (length(camera.eye - camera.target) * nearer);
  moved.height = camera.height * nearer;
  return moved;
}

double limited_zoom(const Camera& camera, double factor, double extent) {
  constexpr double nearest = 1e-4, farthest = 10;
  const double least = std::min(nearest * extent, camera.height), most = std::max(farthest * extent, camera.height);
  return std::clamp(camera.height * factor, least, most) / camera.height;
}

}  // namespace nacre
