// Nacre: reads the volumes of a session for the mesh pipeline.
#include "engine/io/mesh_input.hpp"

#include <cmath>

#include "compute/device/error.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/scene/samples/phantoms.hpp"

namespace nacre {

std::vector<Volume> read_mesh_volumes(const SessionInput& input, const MaterialSettings& settings,
                                      const std::atomic<bool>* stop, const WarningSink& warn, bool mapped) {
  std::vector<Volume> volumes;
  if (!input.sample.empty()) {
    volumes.push_back(make_phantom(input.sample, input.detail, stop));
    add_label_names(volumes.back(), settings.names);
  }
  for (const auto& file : input.inputs) {
    volumes.push_back(read_volume(file, {settings.layer, settings.names, mapped}));
    if (warn)
      for (const std::string& warning : volumes.back().warnings) warn(warning);
    check_stop(stop);
  }
  return volumes;
}

std::optional<SizeImage> read_size_image(const MaterialSettings& settings) {
  if (settings.size_image.empty()) return {};
  const Volume volume = read_volume(settings.size_image);
  SizeImage image{volume.dims, volume.spacing, volume.origin, volume.axes, {}};
  image.size.reserve(volume.voxels());
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) {
          const float size = float(value);
          image.size.push_back(std::isfinite(size) && size > 0 ? size : 0);
        }
      },
      volume.values);
  return image;
}

}  // namespace nacre
