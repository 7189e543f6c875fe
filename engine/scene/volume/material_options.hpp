// Nacre: the options for materials, parsed.
#pragma once

#include "engine/scene/settings/settings.hpp"
#include "engine/scene/volume/materials.hpp"

namespace nacre {

/// Throws Error for values that cannot be parsed, or for options that contradict each other.
MaterialOptions parse_material_settings(const MaterialSettings& settings);

}  // namespace nacre
