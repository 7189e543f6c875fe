// Nacre: antialiased text drawn into an image.
#pragma once

#include <string>
#include <string_view>

#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// Width in pixels of one line of UTF-8 text. `pixels` is the font size (the em): capitals are 0.73 of it high.
/// Control characters count as spaces, invalid UTF-8 as U+FFFD.
int text_width(std::string_view text, float pixels);

/// Height in pixels of the capitals and digits in a line.
int text_cap_height(float pixels);

/// Draws one line of UTF-8 text: its left edge at `x`, the top of its capitals and digits at `y`. Clipped at the
/// borders.
void draw_text(Image& image, int x, int y, std::string_view text, float pixels, Rgba color);

/// The text, or as much of its beginning as fits into `width` pixels with an ellipsis; empty if nothing fits.
std::string text_to_fit(std::string_view text, float pixels, int width);

/// The TrueType font that is used for this; empty if the build found none.
std::string_view font_bytes();

}  // namespace nacre
