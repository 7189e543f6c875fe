// Nacre: plots hold what they are given, where it belongs, and are well-formed.
#include "engine/picture/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Centres of the dots, in pixels.
std::vector<std::pair<double, double>> dots(const std::string& svg) {
  static const std::regex circle("<circle cx=\"([-0-9.]+)\" cy=\"([-0-9.]+)\"");
  std::vector<std::pair<double, double>> all;
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle); it != std::sregex_iterator(); ++it)
    all.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  return all;
}

/// Heights of the bars' parts: rectangles that are neither the page nor the legend.
std::vector<double> heights(const std::string& svg) {
  static const std::regex rect("<rect x=\"[-0-9.]+\" y=\"[-0-9.]+\" width=\"([-0-9.]+)\" height=\"([-0-9.]+)\"");
  std::vector<double> all;
  for (std::sregex_iterator it(svg.begin(), svg.end(), rect); it != std::sregex_iterator(); ++it)
    if ((*it)[1] != "14") all.push_back(std::stod((*it)[2]));
  return all;
}

LinePlot line_plot(std::vector<double> x, std::vector<double> y) {
  return {"title", "across", "up", false, false, {}, {{"line", std::move(x), std::move(y), false, -1}}};
}

TEST(LinePlot, PointsLieWhereTheAxesSay) {
  const auto at = dots(svg_line_plot(line_plot({0, 1, 2}, {0, 10, 20})));
  ASSERT_EQ(at.size(), 3u);
  EXPECT_NEAR(at[1].first - at[0].first, at[2].first - at[1].first, 0.2);
  EXPECT_NEAR(at[1].second - at[0].second, at[2].second - at[1].second, 0.2);
  EXPECT_GT(at[2].first, at[0].first);
  EXPECT_LT(at[2].second, at[0].second);  // pixels count downwards
}

TEST(LinePlot, ALogarithmicAxisMakesFactorsEqualSteps) {
  LinePlot plot = line_plot({1, 10, 1000}, {2, 4, 16});
  plot.log_x = plot.log_y = true;
  const auto at = dots(svg_line_plot(plot));
  ASSERT_EQ(at.size(), 3u);
  EXPECT_NEAR(2 * (at[1].first - at[0].first), at[2].first - at[1].first, 0.3);
  EXPECT_NEAR(2 * (at[1].second - at[0].second), at[2].second - at[1].second, 0.3);
}

TEST(LinePlot, WhatCannotBeShownBreaksTheLine) {
  LinePlot plot = line_plot({1, 2, 3, 4, 5}, {1, 2, nan, 4, 5});
  std::string svg = svg_line_plot(plot);
  EXPECT_EQ(dots(svg).size(), 4u);
  const std::string path = svg.substr(svg.find("<path"), svg.find("fill=\"none\"") - svg.find("<path"));
  EXPECT_EQ(count(path, "M"), 2);
  EXPECT_EQ(count(path, "L"), 2);
  EXPECT_EQ(count(svg, "nan"), 0);
  plot.lines[0].y = {1, 0, -3, 4, 5};
  EXPECT_EQ(dots(svg_line_plot(plot)).size(), 5u);
  plot.log_y = true;
  EXPECT_EQ(dots(svg_line_plot(plot)).size(), 3u);
}

TEST(LinePlot, TextIsEscapedAndTheLegendNamesEveryLine) {
  LinePlot plot = line_plot({1, 2}, {3, 4});
  plot.title = "a < b & \"c\"";
  plot.lines.push_back({"second", {1, 2}, {4, 3}, true, -1});
  const std::string svg = svg_line_plot(plot);
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), svg.npos);
  EXPECT_NE(svg.find(">line</text>"), svg.npos);
  EXPECT_NE(svg.find(">second</text>"), svg.npos);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2);  // the second line, and its sample in the legend
  EXPECT_EQ(svg.substr(0, 4), "<svg");
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST(LinePlot, MarksCanBeGiven) {
  LinePlot plot = line_plot({512, 1024, 4096}, {1, 2, 3});
  plot.log_x = true;
  plot.x_ticks = {512, 1024, 4096, 1e9};
  const std::string svg = svg_line_plot(plot);
  for (const char* label : {">512<", ">1024<", ">4096<"}) EXPECT_EQ(count(svg, label), 1) << label;
  EXPECT_EQ(svg.find("10\u2079"), svg.npos);  // beyond the axis
}

TEST(LinePlot, OnePointWillDoAndNoneWillNot) {
  EXPECT_EQ(dots(svg_line_plot(line_plot({5}, {7}))).size(), 1u);
  EXPECT_EQ(dots(svg_line_plot(line_plot({0}, {0}))).size(), 1u);
  EXPECT_THROW(svg_line_plot(line_plot({}, {})), Error);
  EXPECT_THROW(svg_line_plot(line_plot({nan}, {1})), Error);
  EXPECT_THROW(svg_line_plot(line_plot({1, 2}, {1})), Error);
}

TEST(StackedBars, PartsArePutOnTopOfEachOtherAndSumToOne) {
  const std::string svg =
      svg_stacked_bars({"title", "share", {"left", "right"}, {{"low", {1, 10}}, {"high", {3, 10}}}});
  const std::vector<double> h = heights(svg);
  ASSERT_EQ(h.size(), 4u);
  EXPECT_NEAR(h[2] / h[0], 3, 0.01);
  EXPECT_NEAR(h[3], h[1], 0.15);
  EXPECT_NEAR(h[0] + h[2], h[1] + h[3], 0.3);
  for (const char* name : {">left<", ">right<", ">low<", ">high<"}) EXPECT_EQ(count(svg, name), 1) << name;
}

TEST(StackedBars, NamesStandBesideTheirColours) {
  const std::string svg = svg_stacked_bars({"title", "share", {"bar"}, {{"low", {1}}, {"high", {3}}}});
  static const std::regex entry(R"x(<rect x="([-0-9.]+)" y="([-0-9.]+)" width="14" height="14"[^>]*/>\s*)x"
                                R"x(<text x="([-0-9.]+)" y="([-0-9.]+)"[^>]*>(\w+)<)x");
  std::vector<std::string> names;
  for (std::sregex_iterator it(svg.begin(), svg.end(), entry); it != std::sregex_iterator(); ++it) {
    EXPECT_NEAR(std::stod((*it)[3]) - std::stod((*it)[1]), 14 + 8, 0.11);
    EXPECT_NEAR(std::stod((*it)[4]) - std::stod((*it)[2]), 11.5, 0.11);
    names.push_back((*it)[5]);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"low", "high"}));
}

TEST(StackedBars, EmptyOnesAreEmptyAndWrongOnesAreRefused) {
  for (const double h : heights(svg_stacked_bars({"title", "share", {"bar"}, {{"part", {0}}}}))) EXPECT_EQ(h, 0);
  for (const double h : heights(svg_stacked_bars({"title", "share", {"bar"}, {{"part", {nan}}}}))) EXPECT_EQ(h, 0);
  EXPECT_THROW(svg_stacked_bars({"title", "share", {}, {{"part", {}}}}), Error);
  EXPECT_THROW(svg_stacked_bars({"title", "share", {"bar"}, {}}), Error);
  EXPECT_THROW(svg_stacked_bars({"title", "share", {"bar"}, {{"part", {1, 2}}}}), Error);
}

TEST(LogTicks, DecadesAndTheirParts) {
  EXPECT_EQ(log_ticks(0.5, 2000), (std::vector<double>{1, 10, 100, 1000}));
  const std::vector<double> narrow = log_ticks(3, 60);
  ASSERT_EQ(narrow.size(), 4u);
  EXPECT_NEAR(narrow[0], 5, 1e-12);
  EXPECT_NEAR(narrow[3], 50, 1e-12);
  const std::vector<double> close = log_ticks(310000, 480000);
  ASSERT_GE(close.size(), 2u);
  EXPECT_NEAR(close[0], 350000, 1e-6);
}

}  // namespace
}  // namespace nacre
