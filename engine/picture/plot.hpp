// Nacre: plots as SVG text: lines over a plain or logarithmic axis, and stacked bars.
#pragma once

#include <string>
#include <vector>

namespace nacre {

/// A line through points in their order. A point that is not finite, or not positive on a logarithmic axis, is left out
/// and breaks the line.
struct PlotLine {
  std::string name;  ///< for the legend
  std::vector<double> x, y;
  bool dashed = false;
  int colour = -1;  ///< of eight; -1: by the line's place in the list
};

struct LinePlot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<double> x_ticks;  ///< marks for the x axis; empty: round numbers
  std::vector<PlotLine> lines;
};

/// One part of every bar: `values[i]`, not negative, belongs to bar i.
struct BarPart {
  std::string name;
  std::vector<double> values;
};

/// Bars of parts on top of each other, from the first upwards; each bar is scaled to a sum of 1.
struct StackedBars {
  std::string title, y_label;
  std::vector<std::string> bars;  ///< names under the bars
  std::vector<BarPart> parts;
};

/// A whole SVG document, 760 pixels wide. An axis that starts at 0 or above and is not logarithmic begins at 0. Throws
/// Error where there is nothing to draw, or x and y of a line differ in length.
std::string svg_line_plot(const LinePlot& plot);

/// The same for bars; a bar without positive parts stays empty. Throws Error where there are no bars, or a part has not
/// one value for each.
std::string svg_stacked_bars(const StackedBars& plot);

/// Marks of a logarithmic axis within [low, high], 0 < low < high: powers of ten, with 2 and 5 times these where the
/// range spans less than two decades; where not even these give two, round numbers as on a plain axis.
std::vector<double> log_ticks(double low, double high);

}  // namespace nacre
