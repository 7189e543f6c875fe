// Nacre: camera presets.
#include "compute/raycast/camera.hpp"

#include <algorithm>
#include <array>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

Vec3d view_direction(const std::string& view) {
  if (view == "iso") return normalized(Vec3d(1.0, -1.3, 0.85));
  if (view == "+x") return {1, 0, 0};
  if (view == "-x") return {-1, 0, 0};
  if (view == "+y") return {0, 1, 0};
  if (view == "-y") return {0, -1, 0};
  if (view == "+z") return {0, 0, 1};
  if (view == "-z") return {0, 0, -1};
  throw Error("no camera '" + view + "'", "", "use iso, +x, -x, +y, -y, +z, -z or a JSON file");
}

}  // namespace

Camera fit_camera(const std::string& view, std::span<const Vec3d> points, int width, int height) {
  const Vec3d direction = view_direction(view);
  Vec3d lower(1e300), upper(-1e300);
  for (const Vec3d& p : points) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  if (points.empty()) lower = upper = Vec3d(0.0);
  const double radius = std::max(0.5 * length(upper - lower), 1e-30), distance = 9 * radius;
  Camera camera;
  camera.up = std::fabs(direction.z) > 0.99 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  camera.target = (lower + upper) * 0.5;
  camera.eye = camera.target + direction * distance;
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  // What the points cover as the camera sees them, brought to the distance of the target.
  double left = 1e300, most_right = -1e300, bottom = 1e300, top = -1e300;
  for (const Vec3d& p : points) {
    const Vec3d d = p - camera.target;
    const double nearer = distance / (distance - dot(d, direction));
    left = std::min(left, dot(d, right) * nearer);
    most_right = std::max(most_right, dot(d, right) * nearer);
    bottom = std::min(bottom, dot(d, up) * nearer);
    top = std::max(top, dot(d, up) * nearer);
  }
  if (points.empty()) left = most_right = bottom = top = 0;
  const Vec3d shift = right * (0.5 * (left + most_right)) + up * (0.5 * (bottom + top));
  camera.target += shift;
  camera.eye += shift;
  const double aspect = double(width) / std::max(height, 1);
  camera.height = 1.12 * std::max({top - bottom, (most_right - left) / aspect, 1e-6 * radius});
  return camera;
}

Camera fit_camera(const std::string& view, const Vec3d& lower, const Vec3d& upper, int width, int height) {
  std::array<Vec3d, 8> corners;
  for (int k = 0; k < 8; ++k)
    corners[k] = {k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z};
  return fit_camera(view, corners, width, height);
}

Camera orbit(const Camera& camera, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
  const Vec3d axis = normalized(camera.up), d = camera.eye - camera.target;
  Camera turned = camera;
  turned.eye = camera.target + d * c + cross(axis, d) * s + axis * (dot(axis, d) * (1 - c));
  return turned;
}

}  // namespace nacre
