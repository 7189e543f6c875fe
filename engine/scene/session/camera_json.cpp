// Nacre: a camera as JSON.
#include "engine/scene/session/camera_json.hpp"

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

nlohmann::json numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

Vec3d vec(const nlohmann::json& json) {
  const auto v = json.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

}  // namespace

nlohmann::json camera_json(const Camera& camera) {
  return {{"eye", numbers(camera.eye)},
          {"target", numbers(camera.target)},
          {"up", numbers(camera.up)},
          {"height", camera.height},
          {"orthographic", camera.orthographic}};
}

Camera camera_of(const nlohmann::json& json, double height) {
  Camera camera;
  try {
    camera.eye = vec(json.at("eye"));
    camera.target = vec(json.at("target"));
    camera.up = json.contains("up") ? vec(json.at("up")) : Vec3d(0, 0, 1);
    camera.height = json.value("height", height);
    camera.orthographic = json.value("orthographic", false);
  } catch (const nlohmann::json::exception& error) {
    throw Error("this is not a camera", error.what(), camera_advice);
  }
  if (!(length(camera.target - camera.eye) > 0) || !(length(camera.up) > 0) || !(camera.height > 0))
    throw Error("this is not a camera", "eye and target must differ, up must not be zero, and height must be positive",
                camera_advice);
  return camera;
}

bool is_camera_file(const std::string& camera) { return std::filesystem::path(camera).extension() == ".json"; }

}  // namespace nacre
