// Nacre: the colour legend and the time stamp.
#include "engine/picture/legend.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/picture/lettering.hpp"
#include "engine/picture/text.hpp"
#include "engine/picture/ticks.hpp"

namespace nacre {
namespace {

int rounded(float x) { return int(std::lround(x)); }

/// Rows of a legend's bar.
struct Rows {
  int first, count;
};

Rows bar_rows(int height, float font) {
  const int first = rounded(0.11f * float(height) + 2.2f * font);
  const int above_orientation = height - rounded(10 * font) - first;
  return {first, std::clamp(above_orientation, rounded(5 * font), height / 2)};
}

int bar_width(float font) { return rounded(1.2f * font); }
int bar_gap(float font) { return rounded(0.65f * font); }  // to the numbers

/// Positions of the parts of a legend, in pixels.
struct Layout {
  float font = 0;
  int bar_x = 0, bar_y = 0, bar_width = 0, bar_height = 0;
  int line = 1;  ///< width of the frame and the ticks
  int label_x = 0, right = 0;
};

int widest(const std::vector<std::string>& labels, float font) {
  int width = 0;
  for (const std::string& label : labels) width = std::max(width, text_width(label, font));
  return width;
}

/// False if the legend would be wider than a quarter of the image, or the image is too small for text.
bool lay_out(const Image& image, const Ticks& ticks, Layout& out) {
  out.font = lettering_size(image);
  if (out.font <= 0) return false;
  const int margin = rounded(out.font), gap = bar_gap(out.font);
  out.line = std::max(1, rounded(out.font / 16));
  out.bar_width = bar_width(out.font);
  const int exponent_width = ticks.exponent != 0 ? text_width(power_of_ten(ticks.exponent), out.font) : 0;
  const int width =
      out.bar_width + gap + std::max(widest(ticks.labels, out.font), exponent_width - out.bar_width - gap);
  if (width + margin > image.width / 4) return false;
  out.right = image.width - margin;
  out.bar_x = out.right - width;
  out.label_x = out.bar_x + out.bar_width + gap;
  const Rows rows = bar_rows(image.height, out.font);
  out.bar_y = rows.first;
  out.bar_height = rows.count;
  return true;
}

Rgba ink_of(const std::array<float, 3>& c) {
  const auto byte = [](float v) { return std::uint8_t(rounded(255 * std::clamp(v, 0.f, 1.f))); };
  return {byte(c[0]), byte(c[1]), byte(c[2])};
}

void draw_bar(Image& image, const Layout& at, const Colormap& map, const Ink& ink) {
  const Rgba frame{ink.letter.r, ink.letter.g, ink.letter.b, 200};
  fill_box(image, at.bar_x - at.line, at.bar_y - at.line, at.bar_width + 2 * at.line, at.bar_height + 2 * at.line,
           frame);
  const float last = float(map.table.size() - 1);
  for (int row = 0; row < at.bar_height; ++row) {
    const float t = 1 - (float(row) + 0.5f) / float(at.bar_height);
    fill_box(image, at.bar_x, at.bar_y + row, at.bar_width, 1, ink_of(map.table[std::size_t(rounded(t * last))]));
  }
}

/// Boxes beyond the ends of the bar, and one below them for what is no number.
void draw_beyond(Image& image, const Layout& at, const LegendScale& scale, const Ink& ink) {
  const Rgba frame{ink.letter.r, ink.letter.g, ink.letter.b, 200};
  const int high = rounded(0.7f * at.font), gap = std::max(2, rounded(0.2f * at.font));
  const auto box = [&](int y, const std::array<float, 3>& colour) {
    fill_box(image, at.bar_x - at.line, y - at.line, at.bar_width + 2 * at.line, high + 2 * at.line, frame);
    fill_box(image, at.bar_x, y, at.bar_width, high, ink_of(colour));
  };
  if (scale.above) box(at.bar_y - gap - high, *scale.above);
  int y = at.bar_y + at.bar_height + gap;
  if (scale.below) box(y, *scale.below), y += high + gap;
  if (!scale.no_number) return;
  y += gap;
  box(y, *scale.no_number);
  draw_lettering(image, at.label_x, y + (high - text_cap_height(at.font)) / 2, "NaN", at.font, ink);
}

void draw_ticks(Image& image, const Layout& at, const Ticks& ticks, double min, double max, bool log, const Ink& ink) {
  const int cap = text_cap_height(at.font), length = rounded(0.3f * at.font);
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double share =
        log ? std::log(ticks.values[i] / min) / std::log(max / min) : (ticks.values[i] - min) / (max - min);
    const double t = max > min ? share : 0.5;
    const int y = at.bar_y + rounded(float((1 - t) * at.bar_height));
    fill_box(image, at.bar_x + at.bar_width + at.line, y - at.line / 2, length, at.line, ink.letter);
    draw_lettering(image, at.label_x, y - cap / 2, ticks.labels[i], at.font, ink);
  }
}

/// The title is above the bar, or ends at the right border if it is longer than the legend is wide.
void draw_title(Image& image, const Layout& at, const std::string& title, int exponent, bool box, const Ink& ink) {
  const int line_height = rounded(1.45f * at.font);
  int y = at.bar_y - rounded((box ? 2.8f : 1.9f) * at.font);
  if (exponent != 0) {
    draw_lettering(image, at.bar_x, y, power_of_ten(exponent), at.font, ink);
    y -= line_height;
  }
  const std::string fitting = text_to_fit(title, at.font, image.width / 4 - (image.width - at.right));
  const int x = std::min(at.bar_x, at.right - text_width(fitting, at.font));
  draw_lettering(image, x, y, fitting, at.font, ink);
}

}  // namespace

void draw_legend(Image& image, const Colormap& map, double min, double max, const std::string& title,
                 const LegendScale& scale) {
  if (min > max) std::swap(min, max);
  if (map.table.empty()) return;
  const float font = lettering_size(image);
  if (font <= 0) return;
  const int count = std::clamp(int(float(image.height) / 2 / (3 * font)), 2, 8);
  const bool log = scale.log && min > 0;
  const Ticks ticks = log ? log_ticks(min, max, count) : nice_ticks(min, max, count);
  Layout layout;
  if (!lay_out(image, ticks, layout)) return;
  const int left = image.width - image.width / 4;
  const Ink ink = ink_for(image, left, layout.bar_y - rounded(3 * font), image.width - left, layout.bar_height);
  draw_bar(image, layout, map, ink);
  draw_beyond(image, layout, scale, ink);
  draw_ticks(image, layout, ticks, min, max, log, ink);
  draw_title(image, layout, title, ticks.exponent, scale.above.has_value(), ink);
}

KeptFree legend_room(int width, int height) {
  const float font = lettering_size(width, height), halo = font / 6 + 1;
  if (font <= 0) return {};
  const int margin = rounded(font), bar = bar_width(font) + bar_gap(font);
  if (bar + text_width("0", font) + margin > width / 4) return {};
  const float widest = float(bar + text_width("\u22120.000", font) + margin);
  const Rows rows = bar_rows(height, font);
  const int quarter = width / 4;
  const float left = float(width) - std::min(widest, float(quarter)) - halo;
  const float top = float(rows.first) - 3.4f * font, bottom = float(rows.first + rows.count) + 0.5f * font;
  return {left / float(width), top / float(height), bottom / float(height)};
}

void draw_time(Image& image, double t, const std::string& unit, double step) {
  const float font = lettering_size(image);
  if (font <= 0 || !std::isfinite(t)) return;
  const bool plain = std::abs(t) < 1e6 && step > 1e-6 && step < 1e6;
  const std::string number =
      plain ? fixed_number(t, std::max(0, int(std::ceil(1 - std::log10(step) - 1e-9)))) : short_number(t, 4);
  const std::string text = text_to_fit("t = " + number + (unit.empty() ? "" : " " + unit), font, image.width / 2);
  const int margin = rounded(font), cap = text_cap_height(font), width = text_width(text, font);
  const int y = image.height - margin - cap;
  draw_lettering(image, margin, y, text, font, ink_for(image, margin, y, width, cap));
}

}  // namespace nacre
