// Nacre: what the knobs of the colours mean for given data: the same for pictures without OpenGL and for the viewer.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include "engine/picture/colormap.hpp"
#include "engine/picture/legend.hpp"
#include "engine/scene/settings/ranges.hpp"

namespace nacre {

/// "#rrggbb" as 0..1; none: it is something else.
inline std::optional<std::array<float, 3>> hex_colour(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    return {};
  const auto number = std::uint32_t(std::strtoul(text.c_str() + 1, nullptr, 16));
  return std::array{float(number >> 16) / 255, float(number >> 8 & 255) / 255, float(number & 255) / 255};
}

struct ShownColours {
  ColourRange range;
  std::array<float, 3> below, above, no_number;  ///< sRGB
  LegendScale scale;
};

/// Throws Error like `color_range`. A colour that is none counts as left out.
inline ShownColours shown_colours(const Settings& settings, const Colormap& map, const ColourSpread& data) {
  ShownColours shown;
  shown.range = color_range(settings, data);
  shown.scale.log = shown.range.log;
  shown.scale.below = hex_colour(settings.color_below);
  shown.scale.above = hex_colour(settings.color_above);
  shown.below = shown.scale.below.value_or(map.table.front());
  shown.above = shown.scale.above.value_or(map.table.back());
  shown.no_number = hex_colour(settings.color_nan).value_or(std::array{0.5f, 0.5f, 0.5f});
  if (data.gaps) shown.scale.no_number = shown.no_number;
  return shown;
}

}  // namespace nacre
