// Nacre: which scene an input belongs to.
#include "app/viewer/scene.hpp"

#include "compute/device/error.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/scene/phantoms.hpp"

namespace nacre {

bool is_mesh_input(const SessionInput& input) {
  return input.inputs.empty() ? is_phantom(input.sample) : is_volume_file(input.inputs.front());
}

std::unique_ptr<Scene> make_mesh_scene(const Session&, const SceneOptions&) {
  throw Error("volumes cannot be viewed yet");
}

}  // namespace nacre
