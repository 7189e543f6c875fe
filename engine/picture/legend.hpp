// Nacre: what is drawn over a picture: colour legend, time stamp, axes.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "compute/math/vec.hpp"
#include "compute/raycast/camera.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// How a legend is read, beyond the map and its ends.
struct LegendScale {
  bool log = false;                                  ///< equal ratios are equal distances
  std::optional<std::array<float, 3>> below, above;  ///< of values beyond the ends, sRGB; none: those of the map
  std::optional<std::array<float, 3>> no_number;     ///< where there is no number; none: that does not occur
};

/// A vertical colour bar at the right border with ticks at round numbers, and `title` above it. `min` and `max` are the
/// values at the lower and upper end of the bar; numbers are left out if they are not finite. The size depends on the
/// image; the legend is never wider than a quarter of it. If it would not be readable (in images below about 200
/// pixels) it is left out.
void draw_legend(Image& image, const Colormap& map, double min, double max, const std::string& title,
                 const LegendScale& scale = {});

/// The area in which draw_legend draws in an image of that size: the bar, numbers of six characters, and as much of a
/// title as fits above these. Empty if the image is too small for a legend.
KeptFree legend_room(int width, int height);

/// "t = 0.125 s" at the bottom left; `unit` may be empty. `step` (the time between frames, in the same unit; 0 if
/// unknown) determines the number of decimals, so that the stamp does not flicker in a video.
void draw_time(Image& image, double t, const std::string& unit, double step = 0);

/// Small coordinate axes (x red, y green, z blue) at the bottom right, as the camera sees them. The vectors are those
/// of the camera, in world coordinates, of length 1.
void draw_orientation(Image& image, const Vec3f& right, const Vec3f& up, const Vec3f& forward);

/// The same on a transparent sheet of its own, to be put into the lower right corner of an image of this size with
/// `paper` behind it. Empty if the image is too small.
Image orientation_sheet(int width, int height, const Rgba& paper, const Vec3f& right, const Vec3f& up,
                        const Vec3f& forward);

}  // namespace nacre
