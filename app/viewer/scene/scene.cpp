// Nacre: which scene an input belongs to, and what it can be written as.
#include "app/viewer/scene/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compute/device/error.hpp"
#include "engine/io/mesh_writer.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/system/extension.hpp"

namespace nacre {

bool is_mesh_input(const SessionInput& input) {
  return input.inputs.empty() ? is_phantom(input.sample) : is_volume_file(input.inputs.front());
}

std::vector<std::string> result_formats(const SessionInput& input) {
  return is_mesh_input(input) ? mesh_extensions() : std::vector<std::string>{".vtp"};
}

void require_format(const std::vector<std::string>& formats, const std::filesystem::path& file) {
  if (std::find(formats.begin(), formats.end(), lower_extension(file)) == formats.end())
    throw Error(fmt::format("cannot write {}", file.string()), "its extension says no format of this result",
                fmt::format("use one of {}", fmt::join(formats, " ")));
}

}  // namespace nacre
