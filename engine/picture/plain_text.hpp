// Nacre: letters made of line segments, for programs built without a font.
#pragma once

#include <string_view>

#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// As `text_width` and `draw_text`, but characters beyond ASCII are spelled in ASCII (10^-3).
int plain_text_width(std::string_view text, float pixels);
void draw_plain_text(Image& image, int x, int y, std::string_view text, float pixels, Rgba color);

}  // namespace nacre
