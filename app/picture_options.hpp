// Nacre: options for pictures that several commands take, checked before the work begins.
#pragma once

#include "engine/run/picture_settings.hpp"

namespace nacre {

/// Throws UsageError where `camera` or `background` has no valid value; a camera file is not opened.
void check_picture_options(const Settings& settings);

/// Throws UsageError where a picture as PNG (also a frame in a folder) or a video of that size cannot be written.
void check_picture_size(int width, int height, bool png, bool video);

}  // namespace nacre
