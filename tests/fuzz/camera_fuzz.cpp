// Nacre: fuzz target: cameras.
#include <nlohmann/json.hpp>

#include "engine/scene/session/camera_json.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_text(data, size, [](const std::string& text) {
    try {
      const nacre::Camera camera = nacre::camera_of(nlohmann::json::parse(text));
      if (nacre::camera_of(nacre::camera_json(camera)) != camera) __builtin_trap();
    } catch (const nlohmann::json::exception&) {  // read_camera makes an Error of it
    }
  });
  return 0;
}
