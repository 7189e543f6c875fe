// Nacre: draws all of a scene into a part of a frame: the view with its captions, and slices beside it.
#pragma once

#include <string>

#include "app/viewer/scene/captions.hpp"
#include "app/viewer/scene/layout.hpp"
#include "app/viewer/scene/slice_layout.hpp"
#include "engine/gl/framebuffer.hpp"

namespace nacre {

/// How the knob `layout` cuts an area for a scene.
ViewAreas areas_of(Scene& scene, const ViewSettings& view, const FreeArea& area);

class ScenePainter {
 public:
  /// The frame is bound as a whole afterwards. `turned`: degrees, of a camera that orbits; `heading` as Captions'.
  void draw(const Framebuffer& frame, Scene& scene, const Session& session, double turned, const FreeArea& area,
            const std::string& heading);
  /// Of another scene.
  void forget() { captions_.forget(); }

 private:
  Captions captions_;
  SliceLayout slices_;
};

}  // namespace nacre
