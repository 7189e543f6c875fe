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

/// What a camera sees of some points, at the distance of its target.
struct Extent {
  double left = 0, right = 0, bottom = 0, top = 0;
};

Extent extent_of(std::span<const Vec3d> points, const Camera& camera) {
  if (points.empty()) return {};
  const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward);
  const double distance = length(camera.target - camera.eye);
  Extent seen{1e300, -1e300, 1e300, -1e300};
  for (const Vec3d& p : points) {
    const Vec3d d = p - camera.target;
    const double nearer = camera.orthographic ? 1 : distance / (distance + dot(d, forward));
    seen.left = std::min(seen.left, dot(d, right) * nearer);
    seen.right = std::max(seen.right, dot(d, right) * nearer);
    seen.bottom = std::min(seen.bottom, dot(d, up) * nearer);
    seen.top = std::max(seen.top, dot(d, up) * nearer);
  }
  return seen;
}

/// Moves the centre of `seen` into the middle of the left `share` of the picture, and scales it to fill that part.
Camera centred(Camera camera, const Extent& seen, double aspect, double share, double least) {
  camera.height = 1.12 * std::max({seen.top - seen.bottom, (seen.right - seen.left) / (aspect * share), least});
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  const double across = 0.5 * (seen.left + seen.right) + 0.5 * (1 - share) * camera.height * aspect;
  const Vec3d shift = right * across + up * (0.5 * (seen.bottom + seen.top));
  camera.target += shift;
  camera.eye += shift;
  return camera;
}

/// Whether `seen`, centred in the camera's picture, reaches into the area that is kept free.
bool reaches(const Extent& seen, const Camera& camera, double aspect, const KeptFree& kept) {
  const double right = 0.5 + 0.5 * (seen.right - seen.left) / (camera.height * aspect);
  const double half = 0.5 * (seen.top - seen.bottom) / camera.height;
  return right > kept.left && 0.5 + half > kept.top && 0.5 - half < kept.bottom;
}

}  // namespace

Camera fit_camera(const Camera& from, std::span<const Vec3d> points, int width, int height, const KeptFree& kept) {
  Vec3d lower(1e300), upper(-1e300);
  for (const Vec3d& p : points) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  if (points.empty()) lower = upper = Vec3d(0.0);
  const double radius = std::max(0.5 * length(upper - lower), 1e-30), aspect = double(width) / std::max(height, 1);
  Camera camera = from;
  camera.target = (lower + upper) * 0.5;
  camera.eye = camera.target - from.forward() * (9 * radius);
  const Extent seen = extent_of(points, camera);
  const Camera whole = centred(camera, seen, aspect, 1, 1e-6 * radius);
  return reaches(seen, whole, aspect, kept) ? centred(camera, seen, aspect, kept.left, 1e-6 * radius) : whole;
}

Camera fit_camera(const std::string& view, std::span<const Vec3d> points, int width, int height, const KeptFree& kept) {
  Camera from;
  const Vec3d direction = view_direction(view);
  from.up = std::fabs(direction.z) > 0.99 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  from.eye = direction;
  return fit_camera(from, points, width, height, kept);
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
