// Nacre: the camera of the viewer: mouse and keys.
#pragma once

#include "compute/raycast/camera.hpp"

namespace nacre {

struct PanelState;
class Scene;
struct Session;

/// What keys ask for apart from the camera.
struct KeyWishes {
  bool quit = false;
};

/// Moves the session's camera by what the mouse and the keys have done since the last frame, where no panel wants them; keys also
/// switch what is shown. Between Interface::begin and end.
KeyWishes control_camera(Session& session, const Scene& scene, PanelState& state, int width, int height);

}  // namespace nacre
