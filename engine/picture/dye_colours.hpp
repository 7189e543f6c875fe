// Nacre: how dyes are drawn over a surface: in pictures without OpenGL and in the window alike.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nacre {

inline constexpr std::size_t most_dyes = 4;

/// The colour of each, encoded.
inline constexpr std::array<std::array<std::uint8_t, 3>, most_dyes> dye_inks{
    {{214, 24, 118}, {0, 140, 105}, {240, 130, 0}, {70, 70, 205}}};
/// How far a dye of concentration 1 covers what is under it; others by the square root of their concentration.
inline constexpr double dye_cover = 0.9;
/// What covers a pixel keeps this share of its colour where the pixel is black, and all of it where its light is at
/// least `dye_full_light` of 255, so that the texture remains visible.
inline constexpr double dye_least_light = 0.25, dye_full_light = 170;
/// Concentrations below this are not drawn.
inline constexpr double least_drawn_dye = 0.002;

/// Concentrations at a point, 0 of dyes that there are not.
using DyeMix = std::array<float, most_dyes>;

}  // namespace nacre
