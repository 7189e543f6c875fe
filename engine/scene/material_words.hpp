// Nacre: what the words about materials mean.
#pragma once

#include "engine/scene/materials.hpp"
#include "engine/scene/settings.hpp"

namespace nacre {

/// Throws Error for words that cannot be understood or do not go together.
MaterialOptions parse_material_words(const MaterialWords& words);

}  // namespace nacre
