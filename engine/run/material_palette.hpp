// Nacre: the colours of a volume's materials: the user's, else the file's, else distinct ones.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/picture/oklab.hpp"
#include "engine/scene/session/mesh_materials.hpp"

namespace nacre {

/// "L:#rrggbb[,L:#rrggbb...]", colours by label; what says no label and no colour is left out.
std::map<std::int64_t, Color> parse_label_colours(const std::string& text);
std::string label_colour_text(const std::map<std::int64_t, Color>& colours);

/// "L:0.25[,L:1...]", opacities by label, clamped to 0..1; what says no label and no number is left out.
std::map<std::int64_t, double> parse_label_opacities(const std::string& text);
std::string label_opacity_text(const std::map<std::int64_t, double>& opacities);

/// Per material, encoded sRGB; that of the outside says nothing. `own`: as the knob `material_colors`.
std::vector<Color> material_palette(const MeshInput& input, const std::string& own);

}  // namespace nacre
