// Nacre: plots as SVG text.
#include "engine/picture/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "compute/device/error.hpp"
#include "engine/picture/ticks.hpp"

namespace nacre {
namespace {

constexpr double width = 760, height = 460;
constexpr double letter = 6.6;                                    // width of a character of 11 points
constexpr double left = 84, right = 540, top = 48, bottom = 392;  // of the plotting area; the legend is beside it

/// Colours that colour-blind readers can also distinguish (Okabe and Ito), darkest first.
constexpr std::array<const char*, 8> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000", "#999999"};

const char* colour_of(int colour, std::size_t index) {
  return colours[(colour >= 0 ? std::size_t(colour) : index) % colours.size()];
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  return out;
}

/// The text of a document under construction.
class Svg {
 public:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_ += '\n';
  }
  void begin(const std::string& title, double page_height = height) {
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
        R"(font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="13">)",
        width, page_height);
    add(R"(<rect width="{}" height="{}" fill="#ffffff"/>)", width, page_height);
    add(R"(<text x="{}" y="28" font-size="16" fill="#222222">{}</text>)", left, escaped(title));
  }
  void text(double x, double y, const char* anchor, const std::string& label) {
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="#222222">{}</text>)", x, y, anchor, escaped(label));
  }
  void line(double x0, double y0, double x1, double y1, const char* colour) {
    add(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}"/>)", x0, y0, x1, y1, colour);
  }
  void y_label(const std::string& label) {
    const double y = 0.5 * (top + bottom);
    add(R"~(<text transform="translate(20 {:.1f}) rotate(-90)" text-anchor="middle" fill="#222222">{}</text>)~", y,
        escaped(label));
  }
  std::string end() {
    add("</svg>");
    return std::move(text_);
  }

 private:
  std::string text_;
};

struct PlotAxis {
  double low = 0, high = 1;
  bool log = false;
  Ticks ticks;

  bool has(double v) const { return std::isfinite(v) && (!log || v > 0); }
  double share(double v) const {
    const double a = log ? std::log(low) : low, b = log ? std::log(high) : high;
    return ((log ? std::log(v) : v) - a) / (b - a);
  }
};

PlotAxis make_axis(double low, double high, bool log, const std::vector<double>& marks) {
  PlotAxis axis{low, high, log, {}};
  if (log) {
    const double room = std::pow(high / low, 0.04);
    axis.low = high > low ? low / room : low / 2, axis.high = high > low ? high * room : high * 2;
  } else {
    axis.low = low >= 0 ? 0 : low - 0.05 * (high - low);
    axis.high = high > axis.low ? high + 0.05 * (high - axis.low) : axis.low + 1;
  }
  if (!marks.empty() || log) {
    axis.ticks.values = marks.empty() ? log_ticks(axis.low, axis.high) : marks;
    std::erase_if(axis.ticks.values, [&](double v) { return !axis.has(v) || v < axis.low || v > axis.high; });
    for (const double v : axis.ticks.values) axis.ticks.labels.push_back(short_number(v, 6));
  } else {
    axis.ticks = nice_ticks(axis.low, axis.high, 6);
  }
  return axis;
}

/// Throws Error if a line is invalid, or if no line has a point.
std::array<PlotAxis, 2> axes_of(const LinePlot& plot) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  double low[2]{inf, inf}, high[2]{-inf, -inf};
  const auto visible = [](double v, bool log) { return std::isfinite(v) && (!log || v > 0); };
  for (const PlotLine& line : plot.lines) {
    if (line.x.size() != line.y.size()) throw Error("the line '" + line.name + "' does not have one y for each x");
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const double p[2]{line.x[i], line.y[i]};
      if (!visible(p[0], plot.log_x) || !visible(p[1], plot.log_y)) continue;
      for (int axis = 0; axis < 2; ++axis)
        low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
    }
  }
  if (!(low[0] <= high[0])) throw Error("nothing to plot in '" + plot.title + "'");
  return {make_axis(low[0], high[0], plot.log_x, plot.x_ticks), make_axis(low[1], high[1], plot.log_y, {})};
}

double across(const PlotAxis& axis, double v) { return left + (right - left) * axis.share(v); }
double up(const PlotAxis& axis, double v) { return bottom - (bottom - top) * axis.share(v); }

std::string with_power(const std::string& label, int exponent) {
  return exponent == 0 ? label : label + " (" + power_of_ten(exponent) + ")";
}

void draw_axes(Svg& svg, const PlotAxis& x, const PlotAxis& y, const LinePlot& plot) {
  for (std::size_t i = 0; i < y.ticks.values.size(); ++i) {
    const double at = up(y, y.ticks.values[i]);
    svg.line(left, at, right, at, "#dddddd");
    svg.text(left - 8, at + 4.5, "end", y.ticks.labels[i]);
  }
  for (std::size_t i = 0; i < x.ticks.values.size(); ++i) {
    const double at = across(x, x.ticks.values[i]);
    svg.line(at, bottom, at, bottom + 5, "#222222");
    svg.text(at, bottom + 20, "middle", x.ticks.labels[i]);
  }
  svg.line(left, bottom, right, bottom, "#222222");
  svg.line(left, top, left, bottom, "#222222");
  svg.text(0.5 * (left + right), bottom + 46, "middle", with_power(plot.x_label, x.ticks.exponent));
  svg.y_label(with_power(plot.y_label, y.ticks.exponent));
}

void draw_line(Svg& svg, const PlotAxis& x, const PlotAxis& y, const PlotLine& line, const char* colour) {
  std::string path, dots;
  bool pen_down = false;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (!x.has(line.x[i]) || !y.has(line.y[i])) {
      pen_down = false;
      continue;
    }
    const double at_x = across(x, line.x[i]), at_y = up(y, line.y[i]);
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? " L" : path.empty() ? "M" : " M", at_x, at_y);
    dots += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", at_x, at_y, colour);
    pen_down = true;
  }
  if (path.empty()) return;
  svg.add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2"{}/>)", path, colour,
          line.dashed ? R"( stroke-dasharray="6 4")" : "");
  svg.add("{}", dots);
}

double legend_row(std::size_t i) { return top + 10 + 22 * double(i); }

}  // namespace

std::vector<double> log_ticks(double low, double high) {
  std::vector<double> ticks;
  const bool narrow = high < 100 * low;
  for (int e = int(std::floor(std::log10(low))); e <= int(std::ceil(std::log10(high))); ++e)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double v = factor * std::pow(10.0, e);
      if ((factor == 1 || narrow) && v >= low * (1 - 1e-12) && v <= high * (1 + 1e-12)) ticks.push_back(v);
    }
  if (ticks.size() < 2) ticks = nice_ticks(low, high, 4).values;
  return ticks;
}

std::string svg_line_plot(const LinePlot& plot) {
  const auto [x, y] = axes_of(plot);
  Svg svg;
  svg.begin(plot.title);
  draw_axes(svg, x, y, plot);
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const PlotLine& line = plot.lines[i];
    const char* colour = colour_of(line.colour, i);
    draw_line(svg, x, y, line, colour);
    svg.add(R"(<line x1="{0}" y1="{2}" x2="{1}" y2="{2}" stroke="{3}" stroke-width="2"{4}/>)", right + 16, right + 44,
            legend_row(i), colour, line.dashed ? R"( stroke-dasharray="6 4")" : "");
    svg.text(right + 50, legend_row(i) + 4.5, "start", line.name);
  }
  return svg.end();
}

std::string svg_stacked_bars(const StackedBars& plot) {
  const std::size_t n = plot.bars.size();
  if (n == 0 || plot.parts.empty()) throw Error("nothing to plot in '" + plot.title + "'");
  std::vector<double> sum(n, 0.0);
  for (const BarPart& part : plot.parts) {
    if (part.values.size() != n) throw Error("the part '" + part.name + "' does not have one value for each bar");
    for (std::size_t i = 0; i < n; ++i) sum[i] += std::max(0.0, part.values[i]);
  }
  std::size_t longest = 0;
  for (const std::string& bar : plot.bars) longest = std::max(longest, bar.size());
  Svg svg;
  svg.begin(plot.title, std::max(height, bottom + 30 + 0.87 * letter * double(longest)));  // names slope by 60 degrees
  const PlotAxis y{0, 1, false, nice_ticks(0, 1, 5)};
  LinePlot frame;
  frame.y_label = plot.y_label;
  draw_axes(svg, PlotAxis{}, y, frame);
  const double pitch = (right - left) / double(n);
  std::vector<double> from(n, 0.0);
  for (std::size_t p = 0; p < plot.parts.size(); ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      const double share = sum[i] > 0 ? std::max(0.0, plot.parts[p].values[i]) / sum[i] : 0;
      const double high = up(y, from[i] + share);
      svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)",
              left + pitch * (double(i) + 0.15), high, 0.7 * pitch, up(y, from[i]) - high, colour_of(-1, p));
      from[i] += share;
    }
    const double row = legend_row(plot.parts.size() - 1 - p);  // in the order of the bars
    svg.add(R"(<rect x="{}" y="{}" width="14" height="14" fill="{}"/>)", right + 16, row - 7, colour_of(-1, p));
    svg.text(right + 38, row + 4.5, "start", plot.parts[p].name);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double x = left + pitch * (double(i) + 0.5);
    svg.add(R"x(<text transform="translate({:.1f} {:.1f}) rotate(-60)" text-anchor="end" font-size="11" )x"
            R"x(fill="#222222">{}</text>)x",
            x + 6, bottom + 14, escaped(plot.bars[i]));
  }
  return svg.end();
}

}  // namespace nacre
