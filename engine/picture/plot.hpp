// Nacre: plots as SVG text: lines over a linear or logarithmic axis, and stacked bars.
#pragma once

#include <string>
#include <vector>

namespace nacre {

/// A line through points in their order. A point that is not finite, or not positive on a logarithmic axis, is left out
/// and interrupts the line.
struct PlotLine {
  std::string name;  ///< for the legend
  std::vector<double> x, y;
  bool dashed = false;
  int colour = -1;  ///< of eight; -1: by the position of the line in the list
};

struct LinePlot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<double> x_ticks;  ///< ticks of the x axis; empty: round numbers
  std::vector<PlotLine> lines;
};

/// One part of every bar: `values[i]`, not negative, belongs to bar i.
struct BarPart {
  std::string name;
  std::vector<double> values;
};

/// Bars of parts stacked from the first upwards; each bar is scaled to a sum of 1.
struct StackedBars {
  std::string title, y_label;
  std::vector<std::string> bars;  ///< names under the bars
  std::vector<BarPart> parts;
};

/// A complete SVG document, 760 pixels wide. A linear axis whose values are all 0 or above begins at 0. Throws Error if
/// there is nothing to draw, or if x and y of a line differ in length.
std::string svg_line_plot(const LinePlot& plot);

/// The same for bars; a bar without positive parts stays empty. Throws Error if there are no bars, or if a part does
/// not have one value for each.
std::string svg_stacked_bars(const StackedBars& plot);

/// Ticks of a logarithmic axis within [low, high], 0 < low < high: powers of ten, with 2 and 5 times these if the range
/// spans less than two decades; if not even these give two ticks, round numbers as on a linear axis.
std::vector<double> log_ticks(double low, double high);

}  // namespace nacre
