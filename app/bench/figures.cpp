// Nacre: figures of `nacre bench`.
#include "app/bench/figures.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <set>

#include "engine/picture/plot.hpp"

namespace nacre {
namespace {

using nlohmann::json;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

const json* find_table(const json& report, const std::string& name) {
  for (const json& table : report.at("tables"))
    if (table.at("name") == name) return &table;
  return nullptr;
}

/// "source" or "ours" of a quantity of a row; NaN where it is missing.
double figure(const json& row, const std::string& quantity, const char* whose) {
  const json& values = row.at("values");
  const auto found = values.find(quantity);
  return found == values.end() ? missing : found->value(whose, missing);
}

bool has_points(const PlotLine& line) {
  for (std::size_t i = 0; i < line.x.size(); ++i)
    if (line.x[i] > 0 && line.y[i] > 0) return true;  // false for NaN
  return false;
}

using Figures = std::vector<std::pair<std::string, std::string>>;

void add_plot(Figures& figures, const std::string& file, LinePlot plot) {
  std::erase_if(plot.lines, [](const PlotLine& line) { return !has_points(line); });
  if (!plot.lines.empty()) figures.emplace_back(file, svg_line_plot(plot));
}

/// Time over final particles, for each solver: figures 3.9 and 3.10.
void add_scaling(Figures& figures, const json& report, const char* table_name, const char* file, const char* title) {
  const json* table = find_table(report, table_name);
  if (!table) return;
  LinePlot plot{title, "particles", "seconds", true, true, {}, {}};
  const std::array<const char*, 3> solvers{"serial", "red-black", "tree"};
  for (const char* whose : {"ours", "source"})
    for (std::size_t k = 0; k < solvers.size(); ++k) {
      PlotLine line;
      const bool ours = std::string(whose) == "ours";
      line.name = ours ? fmt::format("{}, ours", solvers[k]) : fmt::format("{}, source", solvers[k]);
      line.dashed = !ours;
      line.colour = int(k);
      for (const json& row : table->at("rows")) {
        line.x.push_back(figure(row, fmt::format("{}: particles", solvers[k]), whose));
        line.y.push_back(figure(row, fmt::format("{}: s", solvers[k]), whose));
      }
      plot.lines.push_back(std::move(line));
    }
  add_plot(figures, file, std::move(plot));
}

/// Shares of the stages for each data set and solver: figure 4.5, the thesis's bars beside ours.
void add_shares(Figures& figures, const json& report) {
  const json* table = find_table(report, "4.3");
  if (!table) return;
  StackedBars plot{"Fig. 4.5: shares of the time to extract a mesh", "share", {}, {}};
  plot.parts = {
      {"distance volume", {}}, {"sizing field", {}}, {"closest point", {}}, {"particles", {}}, {"extract", {}}};
  for (const json& row : table->at("rows"))
    for (const char* whose : {"source", "ours"})
      for (const char* solver : {"serial", "red-black", "tree"}) {
        const double particles = figure(row, fmt::format("particles, {}, s", solver), whose);
        if (!std::isfinite(particles)) continue;
        plot.bars.push_back(fmt::format("{}, {}, {}", row.at("name").get<std::string>(), solver, whose));
        plot.parts[0].values.push_back(figure(row, "distance volume, s", whose));
        plot.parts[1].values.push_back(figure(row, "sizing field, s", whose));
        plot.parts[2].values.push_back(figure(row, "closest point, s", whose));
        plot.parts[3].values.push_back(particles);
        plot.parts[4].values.push_back(figure(row, "extract, s", whose));
      }
  if (!plot.bars.empty()) figures.emplace_back("figure-4.5.svg", svg_stacked_bars(plot));
}

/// Build, step and voxels over the grid's size, for each sample: figure 6.8 a, b, c.
void add_octree(Figures& figures, const json& report) {
  const json* table = find_table(report, "6.1");
  if (!table) return;
  struct Part {
    const char *file, *title, *quantity, *bricks, *label;
  };
  const std::array<Part, 3> parts{
      {{"figure-6.8a.svg", "Fig. 6.8a: build of the octree", "build, s", "bricks: build, s", "seconds"},
       {"figure-6.8b.svg", "Fig. 6.8b: a step of UFLIC", "UFLIC step, s", "bricks: UFLIC step, s", "seconds"},
       {"figure-6.8c.svg", "Fig. 6.8c: voxels of the octree", "voxels", "bricks: voxels", "voxels"}}};
  for (const Part& part : parts) {
    LinePlot plot{part.title, "cells per axis", part.label, true, true, {}, {}};
    std::set<double> sizes;
    int colour = 0;
    for (const std::string sample : {"train", "aircraft", "delta-wing"}) {
      PlotLine ours, bricks, source;
      for (const json& row : table->at("rows")) {
        const std::string name = row.at("name");
        const std::size_t space = name.rfind(' ');
        if (name.substr(0, space) != sample) continue;
        const double size = std::stod(name.substr(space + 1));
        sizes.insert(size);
        for (PlotLine* line : {&ours, &bricks, &source}) line->x.push_back(size);
        ours.y.push_back(figure(row, part.quantity, "ours"));
        bricks.y.push_back(figure(row, part.bricks, "ours"));
        source.y.push_back(figure(row, part.quantity, "source"));
      }
      ours.name = sample + ", octree";
      bricks.name = sample + ", bricks";
      source.name = sample + ", source";
      source.dashed = true;
      ours.colour = source.colour = colour;
      bricks.colour = colour + 3;
      for (PlotLine* line : {&ours, &bricks, &source}) plot.lines.push_back(std::move(*line));
      ++colour;
    }
    plot.x_ticks.assign(sizes.begin(), sizes.end());
    add_plot(figures, part.file, std::move(plot));
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> bench_figures(const json& report) {
  Figures figures;
  add_scaling(figures, report, "3.3", "figure-3.9.svg", "Fig. 3.9: time for a given number of seeds (ribcage)");
  add_scaling(figures, report, "3.4", "figure-3.10.svg", "Fig. 3.10: time for sizing fields (ribcage)");
  add_shares(figures, report);
  add_octree(figures, report);
  return figures;
}

}  // namespace nacre
