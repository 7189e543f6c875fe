// Nacre: series of surfaces that move, and a run on them, for tests.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compute/device/device.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/flow_motion.hpp"
#include "engine/scene/surface/series_motion.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"

namespace nacre::test {

/// Steps at 0, 1/n, .. 1 of a surface.
inline SurfaceSeries moving_series(std::size_t n, std::function<Surface(double time)> at) {
  SurfaceSeries series;
  series.name = "moving";
  for (std::size_t k = 0; k <= n; ++k) series.times.push_back(double(k) / double(n));
  series.load = [times = series.times, at = std::move(at)](std::size_t k) { return at(times[k]); };
  series.moves = true;
  return series;
}

/// A surface with its points where `position` puts them, and with `velocity` on them: that of the points and `along`.
inline Surface moved(Surface surface, double t, const std::function<Vec3d(const Vec3d&, double)>& position,
                     const std::function<Vec3d(const Vec3d&, double)>& along = {}) {
  constexpr double d = 1e-6;
  PointArray velocity{"velocity", 3, {}}, own{"wall_motion", 3, {}};
  for (Vec3d& p : surface.points) {
    const Vec3d wall = (position(p, t + d) - position(p, t - d)) / (2 * d);
    const Vec3d v = along ? wall + along(p, t) : wall;
    p = position(p, t);
    for (int axis = 0; axis < 3; ++axis) {
      velocity.values.push_back(float(v[axis]));
      own.values.push_back(float(wall[axis]));
    }
  }
  surface.arrays = {velocity, own};
  return surface;
}

/// A flow on it from the first to the last time, on one of the embeddings.
struct MovingRun {
  std::vector<std::string> warnings;
  std::unique_ptr<Device> device = make_cpu_device();
  std::unique_ptr<FlowPipeline> pipeline = make_flow_pipeline(*device);
  std::unique_ptr<VectorsInTime> input;
  std::unique_ptr<FlowMotion> motion;

  MovingRun(SurfaceSeries series, const std::string& embedding, Settings settings, int steps, int resolution) {
    settings.vectors = settings.vectors.empty() ? "velocity" : settings.vectors;
    settings.color = "none";
    FlowLog log;
    log.warn = [this](const std::string& sentence) { warnings.push_back(sentence); };
    log.chosen = [](const VectorChoice&) {};
    input = std::make_unique<VectorsInTime>(make_flow_input(std::move(series), settings, log));
    pipeline->parameters = settings.flow;
    choose_embedding(pipeline->parameters, embedding);
    pipeline->parameters.resolution = resolution;
    pipeline->parameters.steps = steps;
    motion = std::make_unique<FlowMotion>(*pipeline, *input, log.warn);
    motion->embed(input->start());
    motion->start(flow_vectors(*input, input->start(), input->end()));
  }

  void steps(int n) {
    for (int k = 0; k < n; ++k) {
      motion->follow();
      pipeline->flow().step();
      motion->show();
    }
  }

  /// Shown at the middles of the triangles as they are now.
  std::vector<float> shown_on_triangles() {
    const std::vector<Vec3d> points = input->points(pipeline->flow().time());
    std::vector<Vec3d> positions;
    for (const Triangle& t : input->surface().triangles)
      positions.push_back((points[t.a] + points[t.b] + points[t.c]) / 3.0);
    return pipeline->flow().sample_shown(positions);
  }

  bool warned_of(const std::string& words) const {
    for (const std::string& warning : warnings)
      if (warning.find(words) != std::string::npos) return true;
    return false;
  }
};

inline double correlation(std::span<const float> a, std::span<const float> b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i] / double(a.size()), mb += b[i] / double(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

/// A plate of n x n squares over [0, 1]^2.
inline Surface plate(int n) {
  Surface s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) s.points.emplace_back(double(i) / n, double(j) / n, 0);
  const auto at = [n](int i, int j) { return std::uint32_t(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return s;
}

/// The texture alone: what flows, without fresh noise.
inline Settings texture_at_rest() {
  Settings settings;
  settings.flow.jitter = 0;
  settings.flow.sharpen = 0;
  settings.flow.streaks = 0;
  settings.flow.equalise = 0;
  return settings;
}

}  // namespace nacre::test
