// Nacre: what the knobs say of a picture: background and camera.
#include "engine/run/picture_settings.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/picture/legend.hpp"
#include "engine/run/shown_colours.hpp"
#include "engine/scene/session/camera_json.hpp"

namespace nacre {

std::array<float, 3> parse_color(const std::string& text) {
  const auto colour = hex_colour(text);
  if (!colour) throw Error("--background takes #rrggbb or transparent, not '" + text + "'");
  return *colour;
}

/// The knobs of colours beyond the map; they may be empty.
static void check_hex(const char* option, const std::string& text) {
  if (!text.empty() && !hex_colour(text)) throw Error(std::string(option) + " takes #rrggbb, not '" + text + "'");
}

void check_picture_settings(const Settings& settings) {
  if (!is_camera_file(settings.camera))
    fit_camera(settings.camera, Vec3d(0), Vec3d(1), settings.width, settings.height);
  if (settings.background != "transparent") parse_color(settings.background);
  check_hex("--color-below", settings.color_below);
  check_hex("--color-above", settings.color_above);
  check_hex("--color-nan", settings.color_nan);
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
