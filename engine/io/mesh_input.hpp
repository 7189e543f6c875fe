// Nacre: reads the volumes of a session for the mesh pipeline, in the same way for `nacre mesh` and the viewer.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "engine/scene/session/mesh_materials.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// The files or the phantom of `input`, with the layer and the names of labels that `settings` say. Throws Error as
/// `read_volume` and `make_phantom` do, and Interrupted soon after `*stop` (may be null) is set. With `mapped` large
/// volumes stay in their files, which then must not change.
std::vector<Volume> read_mesh_volumes(const SessionInput& input, const MaterialSettings& settings,
                                      const std::atomic<bool>* stop, const WarningSink& warn = {}, bool mapped = false);

/// What the knob `size_image` (may be empty) names: any format of volumes, in a frame of its own. Values that are not
/// finite or not above 0 are no wishes. Throws Error as `read_volume` does.
std::optional<SizeImage> read_size_image(const MaterialSettings& settings);

}  // namespace nacre
