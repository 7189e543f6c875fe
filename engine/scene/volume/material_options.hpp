// Nacre: what the words about materials mean.
#pragma once

#include "engine/scene/settings/settings.hpp"
#include "engine/scene/volume/materials.hpp"

namespace nacre {

/// Throws Error for words that cannot be understood or do not go together.
MaterialOptions parse_material_words(const MaterialWords& words);

}  // namespace nacre
