// Nacre: how well a flow texture can be read: whether its streaks point along the flow, and how wide and long they are.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "compute/device/random.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "tests/evidence/point_bins.hpp"

namespace nacre {

/// A square of a texture around a point of the surface, one value per cell in the tangent plane, row by row: rows run
/// along the flow.
struct FlowWindow {
  static constexpr int reach = 16, side = 2 * reach + 1;

  std::array<double, side * side> value;  ///< the mean is 0

  double operator()(int along, int across) const { return value[across * side + along]; }
};

/// Cuts windows out of the values of a surface, whose points lie a texture cell of width `cell` apart.
class WindowCutter {
 public:
  WindowCutter(const FlowValues& values, double cell) : values_(values), cell_(cell), bins_(values.centre, 4 * cell) {}

  /// Around entry `i` of the values; nothing where the flow has no direction, or the surface ends or turns too near.
  std::optional<FlowWindow> cut(std::size_t i) const {
    const Vec3d n = normalized(Vec3d(values_.normal[i])), u(values_.velocity[i]);
    const Vec3d e = normalized(u - n * dot(u, n)), f = cross(n, e);
    if (length(e) == 0) return {};
    std::vector<Vec3d> flat;
    std::vector<float> value;
    bins_.each_within(values_.centre[i], 24 * cell_, [&](std::uint32_t j, double) {
      if (dot(normalized(Vec3d(values_.normal[j])), n) <= 0.7) return;
      const Vec3d way = (values_.centre[j] - values_.centre[i]) / cell_;
      flat.push_back({dot(way, e), dot(way, f), 0});
      value.push_back(values_.value[j]);
    });
    if (flat.size() < 400) return {};
    return resample(flat, value);
  }

 private:
  /// From scattered points to the lattice, by inverse distance among the nearest four.
  static std::optional<FlowWindow> resample(const std::vector<Vec3d>& flat, const std::vector<float>& value) {
    const PointBins bins(flat, 2);
    constexpr int r = FlowWindow::reach, n = FlowWindow::side * FlowWindow::side;
    FlowWindow window;
    std::array<double, n> gap;
    for (int k = 0; k < n; ++k) {
      const Vec3d at(k % FlowWindow::side - r, k / FlowWindow::side - r, 0);
      double sum = 0, weight = 0;
      const auto near = bins.nearest<4>(at, 50);
      for (const PointBins::Neighbour& p : near) {
        const double w = 1 / ((p.distance + 0.2) * (p.distance + 0.2));
        sum += w * value[p.index];
        weight += w;
      }
      window.value[k] = sum / weight;
      gap[k] = near[0].distance;
    }
    const auto holes = std::count_if(gap.begin(), gap.end(), [](double d) { return d > 2.5; });
    std::nth_element(gap.begin(), gap.begin() + n / 2, gap.end());
    if (gap[n / 2] > 1.2 || double(holes) > 0.1 * n) return {};
    const double mean = std::accumulate(window.value.begin(), window.value.end(), 0.0) / n;
    for (double& v : window.value) v -= mean;
    return window;
  }

  const FlowValues& values_;
  double cell_;
  PointBins bins_;
};

/// Angle in degrees, 0 to 90, between a window's flow and the direction in which its middle changes least.
inline double angle_to_flow(const FlowWindow& g) {
  double xx = 0, xy = 0, yy = 0;
  constexpr int first = FlowWindow::reach - 8, last = FlowWindow::reach + 8;
  for (int y = first; y <= last; ++y)
    for (int x = first; x <= last; ++x) {
      const double dx = g(x + 1, y) - g(x - 1, y), dy = g(x, y + 1) - g(x, y - 1);
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  const double most = 0.5 * std::atan2(2 * xy, xx - yy);  // the direction of most change
  return 90 - std::fabs(most) * 180 / std::numbers::pi;
}

/// Lag, in cells, at which a window's autocorrelation has fallen to one half, along the flow or across it; the window's
/// reach where it never does.
inline double half_width(const FlowWindow& g, bool along) {
  constexpr int n = FlowWindow::side;
  double before = 1, whole = 0;
  for (int lag = 0; lag <= FlowWindow::reach; ++lag) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j + lag < n; ++j) sum += along ? g(j, i) * g(j + lag, i) : g(i, j) * g(i, j + lag);
    sum /= double(n) * (n - lag);
    if (lag == 0) whole = sum;
    const double now = sum / whole;
    if (now < 0.5) return lag - 1 + (before - 0.5) / (before - now);
    before = now;
  }
  return FlowWindow::reach;
}

struct Legibility {
  int positions = 0;
  double within = 0;             ///< share of the positions where the texture runs within 15 degrees of the flow
  double slowest_within = 0;     ///< the same among the slowest tenth of the surface
  double width = 0, length = 0;  ///< medians of a streak's half-width and half-length, in texture cells
};

/// Which of `n` entries are looked at.
inline std::vector<std::size_t> chosen_positions(std::size_t n, int count) {
  std::vector<std::size_t> positions;
  for (int k = 0; k < count; ++k) positions.push_back(std::size_t(double(uniform_random(1, k, 0)) * double(n)));
  return positions;
}

/// Looks at `count` positions, chosen at random, always the same ones of the same surface. `cell`: edge of a texture
/// cell.
inline Legibility legibility(const FlowValues& values, double cell, int count = 2000) {
  struct Sight {
    double angle, width, length, rank;
  };
  const std::size_t n = values.value.size();
  std::vector<float> speed(n);
  for (std::size_t i = 0; i < n; ++i) speed[i] = length(values.velocity[i]);
  std::vector<float> sorted = speed;
  std::sort(sorted.begin(), sorted.end());
  const WindowCutter cutter(values, cell);
  const std::vector<std::size_t> chosen = chosen_positions(n, count);
  std::vector<std::optional<Sight>> seen(chosen.size());
  tbb::parallel_for(std::size_t(0), chosen.size(), [&](std::size_t k) {
    const std::size_t i = chosen[k];
    if (speed[i] < 1e-6f * sorted.back()) return;
    const double rank = double(std::lower_bound(sorted.begin(), sorted.end(), speed[i]) - sorted.begin()) / double(n);
    if (const auto window = cutter.cut(i))
      seen[k] = {angle_to_flow(*window), half_width(*window, false), half_width(*window, true), rank};
  });
  Legibility all;
  std::vector<double> widths, lengths;
  int aligned = 0, slow = 0, slow_aligned = 0;
  for (const auto& position : seen) {
    if (!position) continue;
    ++all.positions;
    const bool good = position->angle < 15, is_slow = position->rank < 0.1;
    aligned += good;
    slow += is_slow;
    slow_aligned += good && is_slow;
    widths.push_back(position->width);
    lengths.push_back(position->length);
  }
  const auto middle = [](std::vector<double>& v) {
    std::sort(v.begin(), v.end());
    return v.empty() ? 0 : v[v.size() / 2];
  };
  all.within = double(aligned) / std::max(1, all.positions);
  all.slowest_within = double(slow_aligned) / std::max(1, slow);
  all.width = middle(widths);
  all.length = middle(lengths);
  return all;
}

}  // namespace nacre
