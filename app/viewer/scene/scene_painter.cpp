// Nacre: draws all of a scene into a part of a frame.
#include "app/viewer/scene/scene_painter.hpp"

#include "app/viewer/scene/scene_view.hpp"

namespace nacre {

ViewAreas areas_of(Scene& scene, const ViewSettings& view, const FreeArea& area) {
  return view_areas(view.layout, scene.slices() != nullptr, area);
}

void ScenePainter::draw(const Framebuffer& frame, Scene& scene, const Session& session, double turned,
                        const FreeArea& area, const std::string& heading) {
  const ViewAreas areas = areas_of(scene, session.settings.view, area);
  if (areas.has_view) {
    const FreeArea& part = areas.view;
    frame.bind_part(part.x, frame.height() - part.y - part.height, part.width, part.height);
    const View view = scene_view(session, scene.corners(), turned, part.width, part.height);
    scene.draw(view);
    captions_.draw(scene, view, session.settings, heading);
  }
  if (SliceViews* const slices = scene.slices()) slices_.draw(frame, *slices, areas, session.settings.background);
  frame.bind();
}

}  // namespace nacre
