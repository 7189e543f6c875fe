// Nacre: fewer events for the same way of the camera: a drag of the mouse gives one for each frame.
#pragma once

#include <vector>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// How far a point near the target moves in the picture from one camera to the other, as a share of the picture's
/// height; infinite where one is orthographic and the other is not.
double shift_in_picture(const Camera& a, const Camera& b);

/// The events of the recording, in which cameras that follow each other closely have become one that moves smoothly, as
/// long as no point near the target is ever more than `tolerance` away from where it was (shift_in_picture, at the
/// frames of the recording). What else happens stays, and so do the cameras that are reached in the end, that jump, and
/// that move smoothly already.
std::vector<SessionEvent> thin_cameras(const Session& recording, double tolerance);

}  // namespace nacre
