// Nacre: what dragging does to a clip plane in the view.
#include "app/viewer/scene/clip_drag.hpp"

#include <algorithm>
#include <cmath>

#include "app/viewer/scene/marks.hpp"

namespace nacre {

std::optional<std::array<double, 2>> PictureArea::pixel_of(const Vec3d& point) const {
  View view;
  view.camera = camera;
  view.width = area.width;
  view.height = area.height;
  std::optional<std::array<double, 2>> at = nacre::pixel_of(view, point);
  if (at) *at = {(*at)[0] + area.x, (*at)[1] + area.y};
  return at;
}

ViewRay PictureArea::ray_through(double x, double y) const {
  const auto [right, up] = position_in(area, x, y);
  return ray_under(camera, right, up, area.aspect());
}

double PictureArea::pixel_size(const Vec3d& point) const {
  const double at_target = camera.height / std::max(1, area.height);
  if (camera.orthographic) return at_target;
  return at_target * dot(point - camera.eye, camera.forward()) / length(camera.target - camera.eye);
}

WorldPlane pushed_to(const WorldPlane& plane, const BoxCorners& box, const PictureArea& picture, double x, double y) {
  constexpr double end_on = 0.06;  // squared sine of the angle between normal and ray
  const auto [from, along] = picture.ray_through(x, y);
  const double towards = dot(along, plane.normal), sine2 = 1 - towards * towards;
  double way = 0;
  if (sine2 > end_on) {
    const Vec3d back = from - plane.point;
    way = (dot(back, plane.normal) - dot(back, along) * towards) / sine2;
  } else if (const auto seen = picture.pixel_of(plane.point)) {
    way = ((*seen)[1] - y) * picture.pixel_size(plane.point) * (towards < 0 ? -1 : 1);
  }
  const auto [low, high] = offset_range(plane.normal, box);
  way = std::clamp(plane.offset() + way, low, high) - plane.offset();
  return {plane.normal, plane.point + plane.normal * way};
}

WorldPlane turned_to(const WorldPlane& plane, double arrow, const PictureArea& picture, double x, double y) {
  const auto [from, along] = picture.ray_through(x, y);
  const Vec3d nearest = from + along * dot(plane.point - from, along), beside = nearest - plane.point;
  const double deep2 = arrow * arrow - dot(beside, beside);
  const Vec3d to_eye = picture.camera.orthographic ? -along : picture.camera.eye - plane.point;
  const double side = dot(plane.normal, to_eye) < 0 ? 1 : -1;
  const Vec3d tip = deep2 > 0 ? beside + along * (side * std::sqrt(deep2)) : beside;
  return {length(tip) > 0 ? normalized(tip) : plane.normal, plane.point};
}

std::optional<Vec3d> handle_of(const WorldPlane& plane, const BoxCorners& box) {
  const std::vector<Vec3d> outline = plane_outline(plane, box);
  if (outline.empty()) return {};
  const Vec3d &low = box.front(), &high = box.back(), &p = plane.point;
  bool inside = true;
  for (int a = 0; a < 3; ++a) {
    const double slack = 1e-6 * (high[a] - low[a]);
    inside = inside && p[a] >= low[a] - slack && p[a] <= high[a] + slack;
  }
  if (inside) return p;
  Vec3d middle;
  for (const Vec3d& corner : outline) middle += corner / double(outline.size());
  return middle;
}

}  // namespace nacre
