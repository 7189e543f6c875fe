// Nacre: antialiased text, from the TrueType font that is embedded in the program.
#include "engine/picture/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/picture/plain_text.hpp"
#include "engine/system/utf8.hpp"

#ifdef NACRE_HAS_FONT
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_truetype.h>

extern "C" {
extern const unsigned char nacre_font_begin[];
extern const unsigned char nacre_font_end[];
}
#endif

namespace nacre {
namespace {

constexpr float cap_height_of_em = 0.729f;

#ifdef NACRE_HAS_FONT

/// The embedded font, or nullptr if its bytes are not a font.
const stbtt_fontinfo* font() {
  static const struct Font {
    stbtt_fontinfo info{};
    bool usable = stbtt_InitFont(&info, nacre_font_begin, 0) != 0;
  } loaded;
  return loaded.usable ? &loaded.info : nullptr;
}

/// Calls visit(glyph, x) for each glyph, x in pixels from the left edge, and returns the width of the line in pixels.
template <class Visit>
float lay_out(const stbtt_fontinfo& face, std::string_view text, float scale, Visit&& visit) {
  float x = 0;
  int previous = 0;
  while (!text.empty()) {
    const int glyph = stbtt_FindGlyphIndex(&face, int(take_code_point(text)));
    if (previous != 0) x += scale * float(stbtt_GetGlyphKernAdvance(&face, previous, glyph));
    visit(glyph, x);
    int advance = 0;
    stbtt_GetGlyphHMetrics(&face, glyph, &advance, nullptr);
    x += scale * float(advance);
    previous = glyph;
  }
  return x;
}

/// Draws a glyph with its origin at (x, baseline); `x` may lie between pixels.
void draw_glyph(Image& image, const stbtt_fontinfo& face, int glyph, float scale, float x, int baseline, Rgba color) {
  const float whole = std::floor(x);
  int width = 0, height = 0, left = 0, top = 0;
  unsigned char* coverage =
      stbtt_GetGlyphBitmapSubpixel(&face, scale, scale, x - whole, 0, glyph, &width, &height, &left, &top);
  if (!coverage) return;
  left += int(whole);
  top += baseline;
  for (int v = std::max(0, -top); v < std::min(height, image.height - top); ++v)
    for (int u = std::max(0, -left); u < std::min(width, image.width - left); ++u)
      blend_pixel(image.at(left + u, top + v), color, float(coverage[v * width + u]) / 255);
  stbtt_FreeBitmap(coverage, nullptr);
}

#endif

}  // namespace

int text_cap_height(float pixels) { return int(std::lround(cap_height_of_em * pixels)); }

int text_width(std::string_view text, float pixels) {
#ifdef NACRE_HAS_FONT
  if (const stbtt_fontinfo* face = font()) {
    const float scale = stbtt_ScaleForMappingEmToPixels(face, pixels);
    return int(std::ceil(lay_out(*face, text, scale, [](int, float) {})));
  }
#endif
  return plain_text_width(text, pixels);
}

void draw_text(Image& image, int x, int y, std::string_view text, float pixels, Rgba color) {
#ifdef NACRE_HAS_FONT
  if (const stbtt_fontinfo* face = font()) {
    const float scale = stbtt_ScaleForMappingEmToPixels(face, pixels);
    const int baseline = y + text_cap_height(pixels);
    lay_out(*face, text, scale, [&](int glyph, float offset) {
      if (float(x) + offset < float(image.width) && float(x) + offset > -4 * pixels)
        draw_glyph(image, *face, glyph, scale, float(x) + offset, baseline, color);
    });
    return;
  }
#endif
  draw_plain_text(image, x, y, text, pixels, color);
}

std::string text_to_fit(std::string_view text, float pixels, int width) {
  // Nothing longer fits on any line; the limit also bounds the work on an absurdly long array name.
  constexpr std::size_t longest = 400;
  const std::string ellipsis = "\u2026";
  if (text.size() <= longest && text_width(text, pixels) <= width) return std::string(text);
  std::size_t fitting = 0;
  for (std::string_view rest = text.substr(0, longest); !rest.empty();) {
    take_code_point(rest);
    const std::size_t end = std::min(text.size(), longest) - rest.size();
    if (text_width(std::string(text.substr(0, end)) + ellipsis, pixels) > width) break;
    fitting = end;
  }
  return fitting > 0 ? std::string(text.substr(0, fitting)) + ellipsis : std::string();
}

std::string_view font_bytes() {
#ifdef NACRE_HAS_FONT
  return {reinterpret_cast<const char*>(nacre_font_begin), std::size_t(nacre_font_end - nacre_font_begin)};
#else
  return {};
#endif
}

}  // namespace nacre
