// Nacre: what a volume is, in the tab "data": size, type, how its values are spread, where it is cut.
#pragma once

#include "app/viewer/mesh/viewed_volume.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// Draws it with Dear ImGui. For a scalar volume with one iso-value, a slider under the histogram moves that.
void draw_volume_facts(const ViewedVolume& volume, Session& session);

}  // namespace nacre
