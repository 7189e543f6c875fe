// Nacre: critical points, separatrices and streamlines, drawn over a picture.
#pragma once

#include "compute/raycast/camera.hpp"
#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"
#include "engine/run/flow_skeleton.hpp"
#include "engine/run/flow_tracks.hpp"

namespace nacre {

/// What the window draws in the same colours.
Rgba mark_colour(CriticalKind kind);
inline constexpr Rgba mark_outline{20, 20, 20, 255}, separatrix_with_flow{255, 150, 30, 255},
    separatrix_against_flow{120, 220, 255, 255}, separation_colour{230, 60, 190, 255},
    attachment_colour{110, 230, 120, 255}, streamline_ink{25, 28, 36, 220}, track_colour{255, 220, 40, 255},
    later_track_colour{215, 205, 165, 255};

/// Draws what the camera sees of it and nothing of the surface hides: sources red, sinks blue, centres green, as discs,
/// a focus with a hole; saddles as yellow diamonds; separatrices in orange with the flow and in light blue against it;
/// separation in magenta, attachment in light green; closed orbits, thicker, in blue if
/// they attract, in red if they repel.
void draw_skeleton(Image& image, const Camera& camera, const FlowSkeleton& skeleton);

/// Draws what the camera sees of the paths of critical points in time: yellow up to `now`, pale from then on. `shape`:
/// the surface as it is now.
void draw_tracks(Image& image, const Camera& camera, const FlowTracks& tracks, double now,
                 const PreparedSurface& shape);

/// Draws what the camera sees of them, as thin dark lines.
void draw_streamlines(Image& image, const Camera& camera, const FlowStreamlines& streamlines);

}  // namespace nacre
