// Nacre: the colours of materials, the same in pictures of `nacre mesh` and in the viewer.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/picture/oklab.hpp"

namespace nacre {

/// A distinct colour for each material: hues a golden angle apart, seven per lightness. Encoded sRGB.
Color material_colour(int material);

/// Facets to the outside have the colour of their material, those between two materials a lighter mixture.
Color pair_colour(const std::array<std::uint16_t, 2>& pair);
/// The same of these colours, one per material.
Color pair_colour(const std::array<std::uint16_t, 2>& pair, std::span<const Color> palette);

}  // namespace nacre
