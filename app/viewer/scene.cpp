// Nacre: which scene an input belongs to.
#include "app/viewer/scene.hpp"

#include "engine/io/volume_reader.hpp"
#include "engine/scene/phantoms.hpp"

namespace nacre {

bool is_mesh_input(const SessionInput& input) {
  return input.inputs.empty() ? is_phantom(input.sample) : is_volume_file(input.inputs.front());
}

}  // namespace nacre
