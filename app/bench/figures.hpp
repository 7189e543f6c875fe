// Nacre: the thesis's figures 3.9, 3.10, 4.5 and 6.8, drawn from the JSON of `nacre bench`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace nacre {

/// File names and SVG documents of those figures whose tables are in `report` and hold something to draw. The thesis's
/// figures are dashed lines beside ours.
std::vector<std::pair<std::string, std::string>> bench_figures(const nlohmann::json& report);

}  // namespace nacre
