// Nacre: text and strokes that are readable on any background.
#pragma once

#include <string_view>

#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"

namespace nacre {

/// A colour for text, and a faint one around it that separates it from a busy background.
struct Ink {
  Rgba letter, halo;
};

/// The font size, in pixels, that suits an image of this size, or 0 if the image is too small for text.
float lettering_size(int width, int height);
inline float lettering_size(const Image& image) { return lettering_size(image.width, image.height); }

/// Dark ink where the part of the image is light, light ink where it is dark.
Ink ink_for(const Image& image, int x, int y, int width, int height);

/// The same for a transparent sheet over a background; dark ink where that is transparent.
Ink ink_on(const Rgba& paper);

/// `draw_text` with a halo.
void draw_lettering(Image& image, int x, int y, std::string_view text, float pixels, const Ink& ink);

/// An antialiased stroke from (x0, y0) with radius r0 to (x1, y1) with radius r1, in pixels, with round ends.
void draw_stroke(Image& image, float x0, float y0, float r0, float x1, float y1, float r1, Rgba color);

/// An opaque or translucent rectangle, clipped at the borders.
void fill_box(Image& image, int x, int y, int width, int height, Rgba color);

}  // namespace nacre
