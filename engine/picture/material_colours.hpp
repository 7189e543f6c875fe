// Nacre: the colours of materials, alike in pictures of `nacre mesh` and in the viewer.
#pragma once

#include <array>
#include <cstdint>

#include "engine/picture/oklab.hpp"

namespace nacre {

/// A colour of its own for each material: hues a golden angle apart, seven to a lightness. Encoded sRGB.
Color material_colour(int material);

/// Facets to the outside have their material's colour, those between two materials a lighter mixture.
Color pair_colour(const std::array<std::uint16_t, 2>& pair);

}  // namespace nacre
