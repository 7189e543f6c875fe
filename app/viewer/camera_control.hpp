// Nacre: the camera of the viewer: mouse and keys.
#pragma once

#include "compute/raycast/camera.hpp"

namespace nacre {

struct PanelState;
class FlowScene;

/// What keys ask for apart from the camera.
struct KeyWishes {
  bool quit = false;
};

/// Moves `camera` by what the mouse and the keys have done since the last frame, where no panel wants them; keys also
/// switch parts of the scene. Between Interface::begin and end.
KeyWishes control_camera(Camera& camera, FlowScene& scene, PanelState& state, int width, int height);

}  // namespace nacre
