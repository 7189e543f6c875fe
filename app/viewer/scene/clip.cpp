// Nacre: the planes that cut a scene.
#include "app/viewer/scene/clip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace nacre {

std::vector<WorldPlane> parse_clip_planes(const std::string& text) {
  std::vector<WorldPlane> planes;
  std::istringstream parts(text);
  for (std::string part; planes.size() < most_clip_planes && std::getline(parts, part, ';');) {
    std::istringstream stream(part);
    Vec3d n, p;
    if (!(stream >> n.x >> n.y >> n.z >> p.x >> p.y >> p.z) || !(length(n) > 0)) continue;
    planes.push_back({normalized(n), p});
  }
  return planes;
}

std::string clip_planes_text(std::span<const WorldPlane> planes) {
  std::string text;
  for (const auto& [n, p] : planes.first(std::min(planes.size(), most_clip_planes)))
    text += fmt::format("{}{:.7g} {:.7g} {:.7g} {:.7g} {:.7g} {:.7g}", text.empty() ? "" : ";", n.x, n.y, n.z, p.x, p.y,
                        p.z);
  return text;
}

std::optional<WorldPlane> axis_clip_plane(const ViewSettings& view, std::span<const Vec3d> corners) {
  const int axis = int(view.clip) - 1;
  if (axis < 0 || axis > 2 || corners.empty()) return {};
  const BoxCorners box = bounding_corners(corners);
  const Vec3d low = box.front(), high = box.back();
  WorldPlane plane{{0, 0, 0}, (low + high) * 0.5};
  plane.normal[axis] = view.clip_back ? -1 : 1;
  plane.point[axis] = low[axis] + view.clip_at * (high[axis] - low[axis]);
  return plane;
}

ClipPlanes clip_planes(const ViewSettings& view, std::span<const Vec3d> corners) {
  ClipPlanes all;
  if (const std::optional<WorldPlane> plane = axis_clip_plane(view, corners)) all.add({plane->normal, plane->offset()});
  for (const WorldPlane& plane : parse_clip_planes(view.clip_planes)) all.add({plane.normal, plane.offset()});
  return all;
}

BoxCorners bounding_corners(std::span<const Vec3d> points) {
  Vec3d low = points.front(), high = low;
  for (const Vec3d& p : points) low = min(low, p), high = max(high, p);
  BoxCorners box;
  for (int k = 0; k < 8; ++k)
    box[std::size_t(k)] = {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
  return box;
}

std::vector<Vec3d> plane_outline(const WorldPlane& plane, const BoxCorners& box) {
  std::array<double, 8> side;
  for (std::size_t k = 0; k < 8; ++k) side[k] = dot(plane.normal, box[k] - plane.point);
  std::vector<Vec3d> outline;
  for (std::size_t k = 0; k < 8; ++k)
    for (const std::size_t bit : {1u, 2u, 4u}) {
      const double a = side[k], b = side[k | bit];
      if ((k & bit) || (a < 0) == (b < 0)) continue;
      outline.push_back(box[k] + (box[k | bit] - box[k]) * (a / (a - b)));
    }
  if (outline.size() < 3) return {};
  Vec3d middle;
  for (const Vec3d& p : outline) middle += p / double(outline.size());
  const Vec3d across = normalized(outline.front() - middle), up = cross(plane.normal, across);
  const auto angle = [&](const Vec3d& p) { return std::atan2(dot(p - middle, up), dot(p - middle, across)); };
  std::sort(outline.begin(), outline.end(), [&](const Vec3d& p, const Vec3d& q) { return angle(p) < angle(q); });
  return outline;
}

std::array<double, 2> offset_range(const Vec3d& normal, const BoxCorners& box) {
  std::array<double, 2> range{dot(normal, box[0]), dot(normal, box[0])};
  for (const Vec3d& p : box) range = {std::min(range[0], dot(normal, p)), std::max(range[1], dot(normal, p))};
  return range;
}

}  // namespace nacre
