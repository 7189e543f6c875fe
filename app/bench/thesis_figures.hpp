// Nacre: the figures of the thesis's tables, which `nacre bench` prints beside its own.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace nacre {

/// One figure of a table, under the names that the bench gives its rows and quantities. Times are in seconds.
struct ThesisFigure {
  std::string_view table, row, quantity;
  double value = 0;
  std::string_view note = {};  ///< what is wrong with it as it is printed
};

/// All figures, table by table.
std::span<const ThesisFigure> thesis_figures();

/// The figure of that name; nullptr where the thesis has none.
const ThesisFigure* find_thesis_figure(std::string_view table, std::string_view row, std::string_view quantity);

}  // namespace nacre
