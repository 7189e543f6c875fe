// Nacre: options for pictures.
#include "app/picture_options.hpp"

#include "app/common.hpp"
#include "engine/picture/png.hpp"
#include "engine/picture/video.hpp"

namespace nacre {

void check_picture_options(const Settings& settings) {
  with_usage_errors([&] { check_picture_settings(settings); });
}

void check_picture_size(int width, int height, bool png, bool video) {
  with_usage_errors([&] {
    if (png) check_png_size(width, height);
    if (video) check_video_size(width, height);
  });
}

}  // namespace nacre
