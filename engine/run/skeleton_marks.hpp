// Nacre: critical points and separatrices, drawn over a picture.
#pragma once

#include "compute/raycast/camera.hpp"
#include "engine/picture/image.hpp"
#include "engine/run/flow_skeleton.hpp"

namespace nacre {

/// Draws what the camera sees of it and nothing of the surface hides: sources red, sinks blue, centres green, as discs,
/// a focus with a hole; saddles as yellow diamonds; separatrices in orange with the flow and in light blue against it.
void draw_skeleton(Image& image, const Camera& camera, const FlowSkeleton& skeleton);

}  // namespace nacre
