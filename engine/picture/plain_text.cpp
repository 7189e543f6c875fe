// Nacre: letters made of line segments, for programs built without a font.
#include "engine/picture/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/system/utf8.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_easy_font.h>

namespace nacre {
namespace {

/// Capitals of stb_easy_font are the upper 7 units of a line; those of a font are 0.73 em high.
constexpr float unit_per_em = 0.73f / 7;

const char* spelled(char32_t point) {
  switch (point) {
    case 0xB0: return " deg";
    case 0xB5:
    case 0x3BC: return "u";
    case 0xB7:
    case 0x22C5: return ".";
    case 0xD7: return "x";
    case 0x2026: return "..";
    case 0x207A: return "+";
    case 0x2212:
    case 0x207B: return "-";
    case 0xB9:
    case 0xB2:
    case 0xB3: return point == 0xB9 ? "1" : point == 0xB2 ? "2" : "3";
    default: return nullptr;
  }
}

bool is_raised(char32_t point) {
  return point == 0xB9 || point == 0xB2 || point == 0xB3 || (point >= 0x2070 && point <= 0x207B);
}

std::string to_ascii(std::string_view text) {
  std::string ascii;
  bool was_raised = false;
  while (!text.empty()) {
    const char32_t point = take_code_point(text);
    if (is_raised(point) && !was_raised) ascii += '^';
    was_raised = is_raised(point);
    if (const char* spelling = spelled(point))
      ascii += spelling;
    else if (point >= 0x2070 && point <= 0x2079)
      ascii += char('0' + (point - 0x2070));
    else
      ascii += point < 0x7F ? char(point) : '?';
  }
  return ascii;
}

/// The area of pixel (x, y) that the rectangle covers, 0..1.
float covered(int x, int y, float x0, float y0, float x1, float y1) {
  const float width = std::min(x1, float(x + 1)) - std::max(x0, float(x));
  const float height = std::min(y1, float(y + 1)) - std::max(y0, float(y));
  return std::max(0.f, width) * std::max(0.f, height);
}

void fill_rectangle(Image& image, float x0, float y0, float x1, float y1, Rgba color) {
  const int first_x = std::max(0, int(std::floor(x0))), last_x = std::min(image.width, int(std::ceil(x1)));
  const int first_y = std::max(0, int(std::floor(y0))), last_y = std::min(image.height, int(std::ceil(y1)));
  for (int y = first_y; y < last_y; ++y)
    for (int x = first_x; x < last_x; ++x) blend_pixel(image.at(x, y), color, covered(x, y, x0, y0, x1, y1));
}

struct Vertex {
  float x, y, z;
  unsigned char color[4];
};

}  // namespace

int plain_text_width(std::string_view text, float pixels) {
  std::string ascii = to_ascii(text);
  return int(std::ceil(float(stb_easy_font_width(ascii.data())) * pixels * unit_per_em));
}

void draw_plain_text(Image& image, int x, int y, std::string_view text, float pixels, Rgba color) {
  std::string ascii = to_ascii(text);
  const float unit = pixels * unit_per_em;
  // No character has more than 16 segments of four vertices.
  std::vector<Vertex> corners(ascii.size() * 16 * 4 + 4);
  const int quads =
      stb_easy_font_print(0, 0, ascii.data(), nullptr, corners.data(), int(corners.size() * sizeof(Vertex)));
  for (int q = 0; q < quads; ++q) {
    const Vertex &low = corners[std::size_t(q) * 4], &high = corners[std::size_t(q) * 4 + 2];
    fill_rectangle(image, float(x) + low.x * unit, float(y) + low.y * unit, float(x) + high.x * unit,
                   float(y) + high.y * unit, color);
  }
}

}  // namespace nacre
