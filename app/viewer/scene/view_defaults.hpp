// Nacre: knobs as the viewer begins with them.
#pragma once

#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// As everywhere, but for the resolution of a flow: coarse enough to move soon.
inline Settings view_defaults() {
  Settings settings;
  settings.flow.resolution = 512;
  return settings;
}

}  // namespace nacre
