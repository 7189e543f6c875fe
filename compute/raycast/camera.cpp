// Nacre: camera presets.
#include "compute/raycast/camera.hpp"

#include <algorithm>

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

Camera fit_camera(const std::string& view, const Vec3d& lower, const Vec3d& upper, int width, int height) {
  const Vec3d direction = view_direction(view);
  const Vec3d half = (upper - lower) * 0.5;
  Camera camera;
  camera.target = (lower + upper) * 0.5;
  camera.up = std::fabs(direction.z) > 0.99 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  const double diagonal = std::max(length(half), 1e-30);
  const double distance = 4.5 * diagonal;
  camera.eye = camera.target + direction * distance;
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  // The box's corners as the camera sees them, brought to the distance of the target.
  double wide = 0, tall = 0;
  for (int k = 0; k < 8; ++k) {
    const Vec3d corner{k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z};
    const double nearer = distance / (distance - dot(corner, direction));
    wide = std::max(wide, std::fabs(dot(corner, right)) * nearer);
    tall = std::max(tall, std::fabs(dot(corner, up)) * nearer);
  }
  const double aspect = double(width) / std::max(height, 1);
  camera.height = 2 * 1.08 * std::max({tall, wide / aspect, 1e-6 * diagonal});
  return camera;
}

Camera orbit(const Camera& camera, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
  const Vec3d axis = normalized(camera.up), d = camera.eye - camera.target;
  Camera turned = camera;
  turned.eye = camera.target + d * c + cross(axis, d) * s + axis * (dot(axis, d) * (1 - c));
  return turned;
}

}  // namespace nacre
