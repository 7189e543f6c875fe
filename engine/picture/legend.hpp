// Nacre: what is drawn over a picture: colour legend, time stamp, axes.
#pragma once

#include <string>

#include "compute/grid/vec.hpp"
#include "compute/raycast/camera.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// A vertical colour bar at the right border with ticks at round numbers, `title` above it. `min` and `max` are the
/// values at the bar's lower and upper end; numbers are left out where they are not finite. Sized by the image and
/// never wider than a quarter of it: where it cannot be read at that size (about 200 pixels) it is left out.
void draw_legend(Image& image, const Colormap& map, double min, double max, const std::string& title);

/// Where draw_legend draws in an image of that size: bar, numbers of six letters, and as much of a title as stands above
/// these. Nothing where the image is too small for a legend.
KeptFree legend_room(int width, int height);

/// "t = 0.125 s" at the bottom left; `unit` may be empty. `step` (the time between frames, in the same unit; 0 where
/// unknown) fixes the number of decimals, so that the stamp does not flicker in a video.
void draw_time(Image& image, double t, const std::string& unit, double step = 0);

/// A small triad of the axes (x red, y green, z blue) at the bottom right, as the camera sees them. The vectors are the
/// camera's, in world coordinates, of length 1.
void draw_orientation(Image& image, const Vec3f& right, const Vec3f& up, const Vec3f& forward);

/// The same on a clear sheet of its own, which belongs into the right lower corner of an image of this size with
/// `paper` behind it. Nothing where that is too small.
Image orientation_sheet(int width, int height, const Rgba& paper, const Vec3f& right, const Vec3f& up,
                        const Vec3f& forward);

}  // namespace nacre
