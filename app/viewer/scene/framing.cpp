// Nacre: keeps a scene in the part of the window that panels and legend leave free.
#include "app/viewer/scene/framing.hpp"

#include "engine/picture/legend.hpp"
#include "engine/scene/session/camera_json.hpp"

namespace nacre {
namespace {

KeptFree kept_free(const Scene& scene, const FreeArea& area) {
  return scene.has_legend() ? legend_room(area.width, area.height) : KeptFree();
}

}  // namespace

Framing::Sight Framing::sight(const Session& session, const Scene& scene, const FreeArea& area) {
  return {area.width, area.height, scene.has_legend(), session.camera && session.camera->orthographic,
          scene.seen_version()};
}

/// Another projection does not move the camera.
bool Framing::is_fitted(const Camera& camera) const {
  if (!fitted_) return false;
  Camera same = *fitted_;
  same.orthographic = camera.orthographic;
  return same == camera;
}

void Framing::take(const Session& session, const Sight& sight) {
  fitted_ = session.camera;
  sight_ = sight;
}

void Framing::keep(Session& session, const Scene& scene, const FreeArea& area, const FirstCamera& first) {
  if (scene.seen().empty()) return;
  if (!session.camera) {
    Settings settings = session.settings;
    settings.width = area.width;
    settings.height = area.height;
    session.camera = first(settings, scene.seen(), scene.has_legend());
    take(session, sight(session, scene, area));
    if (is_camera_file(settings.camera)) fitted_.reset();
  } else if (ready_ && is_fitted(*session.camera) && sight(session, scene, area) != sight_) {
    fit(session, scene, area);
  }
  ready_ = true;
}

void Framing::fit(Session& session, const Scene& scene, const FreeArea& area) {
  if (scene.seen().empty()) return;
  session.camera = fit_camera(*session.camera, scene.seen(), area.width, area.height, kept_free(scene, area));
  take(session, sight(session, scene, area));
}

void Framing::look_from(const std::string& view, Session& session, const Scene& scene, const FreeArea& area) {
  if (scene.seen().empty()) return;
  Camera there = fit_camera(view, scene.seen(), area.width, area.height);
  there.orthographic = session.camera->orthographic;
  session.camera = there;
  fit(session, scene, area);
}

}  // namespace nacre
