// Nacre: options for pictures.
#include "app/picture_options.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/common.hpp"
#include "compute/device/error.hpp"
#include "engine/picture/legend.hpp"
#include "engine/picture/png.hpp"
#include "engine/picture/video.hpp"
#include "engine/scene/session/camera_json.hpp"

namespace nacre {

std::array<float, 3> parse_color(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    throw UsageError("--background takes #rrggbb or transparent, not '" + text + "'");
  const int rgb = std::stoi(text.substr(1), nullptr, 16);
  return {float(rgb >> 16 & 255) / 255, float(rgb >> 8 & 255) / 255, float(rgb & 255) / 255};
}

void check_picture_options(const Settings& settings) {
  with_usage_errors([&] {
    if (!is_camera_file(settings.camera))
      fit_camera(settings.camera, Vec3d(0), Vec3d(1), settings.width, settings.height);
  });
  if (settings.background != "transparent") parse_color(settings.background);
}

void check_picture_size(int width, int height, bool png, bool video) {
  with_usage_errors([&] {
    if (png) check_png_size(width, height);
    if (video) check_video_size(width, height);
  });
}

Camera read_camera(const Settings& settings, std::span<const Vec3d> corners, bool legend) {
  const auto fitted = [&](const std::string& view) {
    const KeptFree kept = legend ? legend_room(settings.width, settings.height) : KeptFree();
    return fit_camera(view, corners, settings.width, settings.height, kept);
  };
  if (!is_camera_file(settings.camera)) return fitted(settings.camera);
  std::ifstream stream(settings.camera);
  if (!stream) throw Error("cannot read camera " + settings.camera);
  try {
    return camera_of(nlohmann::json::parse(stream), fitted("iso").height);
  } catch (const nlohmann::json::exception& error) {
    throw Error(settings.camera + " is not a camera", error.what(), camera_advice);
  } catch (const Error& error) {
    throw Error(settings.camera + ": " + error.what());
  }
}

Camera read_camera(const Session& session, std::span<const Vec3d> corners, bool legend) {
  return session.camera ? *session.camera : read_camera(session.settings, corners, legend);
}

}  // namespace nacre
