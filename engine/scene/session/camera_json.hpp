// Nacre: a camera as JSON: in camera files and in sessions.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "compute/raycast/camera.hpp"

namespace nacre {

/// {"eye":[x,y,z],"target":[x,y,z],"up":[x,y,z],"height":h,"orthographic":false}
nlohmann::json camera_json(const Camera& camera);

/// What such JSON holds, for messages.
inline constexpr const char* camera_advice = R"(it holds {"eye":[x,y,z],"target":[x,y,z],"up":[x,y,z],"height":h})";

/// What is left out of `up`, `height` and `orthographic` is (0, 0, 1), `height` and false. Throws Error where that is
/// no camera: eye and target must differ, up must not be zero, and height must be positive.
Camera camera_of(const nlohmann::json& json, double height = 2);

/// Is the knob "camera" the name of a JSON file, and not of a view?
bool is_camera_file(const std::string& camera);

}  // namespace nacre
