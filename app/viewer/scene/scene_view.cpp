// Nacre: the view of a frame, from the session.
#include "app/viewer/scene/scene_view.hpp"

#include "app/viewer/scene/captions.hpp"
#include "app/viewer/scene/clip.hpp"

namespace nacre {

double diameter_of(std::span<const Vec3d> points) {
  if (points.empty()) return 0;
  Vec3d low = points.front(), high = low;
  for (const Vec3d& p : points) low = min(low, p), high = max(high, p);
  return length(high - low);
}

View scene_view(const Session& session, std::span<const Vec3d> corners, double turned, int width, int height) {
  const Settings& settings = session.settings;
  const ViewSettings& knobs = settings.view;
  View view;
  view.camera = orbit(session.camera.value_or(Camera()), turned);
  view.width = width;
  view.height = height;
  view.light = turned_light(flow_light(view.camera), view.camera, knobs.light_azimuth, knobs.light_height);
  view.clip = clip_planes(knobs, corners);
  view.back_faces = settings.back_faces;
  view.ambient = float(knobs.ambient);
  view.extent = diameter_of(corners) + length(view.camera.eye - view.camera.target);
  return view;
}

std::array<float, 4> background_of(const Settings& settings) {
  const Rgba paper = paper_of(settings.background);
  if (paper.a == 0) return {0, 0, 0, 0};
  return {float(paper.r) / 255, float(paper.g) / 255, float(paper.b) / 255, 1};
}

}  // namespace nacre
