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

/// Calls visit(p, where the camera sees it), from its target to the right and up, at the target's distance.
template <class Visit>
void each_seen(std::span<const Vec3d> points, const Camera& camera, const Visit& visit) {
  const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward);
  const double distance = length(camera.target - camera.eye);
  for (const Vec3d& p : points) {
    const Vec3d d = p - camera.target;
    const double nearer = camera.orthographic ? 1 : distance / (distance + dot(d, forward));
    visit(p, dot(d, right) * nearer, dot(d, up) * nearer);
  }
}

Extent extent_of(std::span<const Vec3d> points, const Camera& camera) {
  if (points.empty()) return {};
  Extent seen{1e300, -1e300, 1e300, -1e300};
  each_seen(points, camera, [&](const Vec3d&, double x, double y) {
    seen.left = std::min(seen.left, x);
    seen.right = std::max(seen.right, x);
    seen.bottom = std::min(seen.bottom, y);
    seen.top = std::max(seen.top, y);
  });
  return seen;
}

double radius_of(const Vec3d& lower, const Vec3d& upper) { return std::max(0.5 * length(upper - lower), 1e-30); }

/// Far from a box, its middle in the picture's.
Camera before_box(const Camera& from, const Vec3d& lower, const Vec3d& upper) {
  Camera camera = from;
  camera.target = (lower + upper) * 0.5;
  camera.eye = camera.target - from.forward() * (9 * radius_of(lower, upper));
  return camera;
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
  const double radius = radius_of(lower, upper), aspect = double(width) / std::max(height, 1);
  const Camera camera = before_box(from, lower, upper);
  const Extent seen = extent_of(points, camera);
  const Camera whole = centred(camera, seen, aspect, 1, 1e-6 * radius);
  return reaches(seen, whole, aspect, kept) ? centred(camera, seen, aspect, kept.left, 1e-6 * radius) : whole;
}

std::vector<Vec3d> outermost(const Camera& from, std::span<const Vec3d> points, const Vec3d& lower,
                             const Vec3d& upper) {
  std::vector<Vec3d> chosen;
  if (points.empty()) return chosen;
  std::array<double, 10> best;
  std::array<Vec3d, 10> at;
  best.fill(1e300);
  each_seen(points, before_box(from, lower, upper), [&](const Vec3d& p, double x, double y) {
    const std::array<double, 10> value{x, -x, y, -y, p.x, -p.x, p.y, -p.y, p.z, -p.z};
    for (std::size_t k = 0; k < value.size(); ++k)
      if (value[k] < best[k]) best[k] = value[k], at[k] = p;
  });
  chosen.assign(at.begin(), at.end());
  return chosen;
}

Camera preset_camera(const std::string& view) {
  Camera from;
  const Vec3d direction = view_direction(view);
  from.up = std::fabs(direction.z) > 0.99 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  from.eye = direction;
  return from;
}

Camera fit_camera(const std::string& view, std::span<const Vec3d> points, int width, int height, const KeptFree& kept) {
  return fit_camera(preset_camera(view), points, width, height, kept);
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
