// Nacre: measures of a texture on an analytic surface: alignment with the flow, motion from frame to frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "compute/device/device.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// A pipeline with a built-in sample in it, started.
struct FlowRun {
  std::unique_ptr<Device> device;
  std::unique_ptr<VectorsInTime> vectors;
  std::unique_ptr<FlowPipeline> pipeline;

  FlowRun(const std::string& sample, const FlowParameters& parameters, int threads = 0, bool steady = true,
          int detail = 0)
      : device(make_cpu_device(threads)) {
    SurfaceSeries series = make_sample(sample, detail);
    if (steady) series.times.resize(1);
    PreparedSurface surface = prepare(series.load(0));
    vectors = std::make_unique<VectorsInTime>(std::move(series), std::move(surface), "velocity", "none");
    pipeline = make_flow_pipeline(*device);
    pipeline->parameters = parameters;
    const PreparedSurface& s = vectors->surface();
    pipeline->embed(flow_mesh(s));
    pipeline->flow().start(flow_vectors(*vectors, vectors->start(), vectors->end()));
  }

  void steps(int n) {
    for (int k = 0; k < n; ++k) pipeline->flow().step();
  }
};

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

inline double correlation(std::span<const float> a, std::span<const float> b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i], mb += b[i];
  ma /= double(a.size());
  mb /= double(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

/// Angles in degrees between the texture's direction and the flow at surface points: the structure tensor of the shown
/// texture in the tangent plane, gradients at a spacing of one texture cell, weighted by a Gaussian of 3 cells.
inline std::vector<double> alignment_errors(FlowPipeline& pipeline, std::span<const Vec3d> points,
                                            std::span<const Vec3f> normals, std::span<const Vec3f> flow,
                                            const std::function<Vec3d(Vec3d)>& onto_surface) {
  const double h = pipeline.flow().embedding().cell_size;
  constexpr int reach = 9, side = 2 * reach + 3;
  std::vector<double> errors;
  std::vector<Vec3d> patch(side * side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d n(normals[i]), e = normalized(Vec3d(flow[i]) - n * dot(n, Vec3d(flow[i]))), f = cross(n, e);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        patch[y * side + x] = onto_surface(points[i] + e * ((x - reach - 1) * h) + f * ((y - reach - 1) * h));
    const std::vector<float> v = pipeline.flow().sample_shown(patch);
    double xx = 0, xy = 0, yy = 0;
    for (int y = 1; y + 1 < side; ++y)
      for (int x = 1; x + 1 < side; ++x) {
        const double gx = v[y * side + x + 1] - v[y * side + x - 1], gy = v[(y + 1) * side + x] - v[(y - 1) * side + x];
        const double r2 = (x - reach - 1) * (x - reach - 1) + (y - reach - 1) * (y - reach - 1);
        const double w = std::exp(-r2 / (2 * 9.0));
        xx += w * gx * gx;
        xy += w * gx * gy;
        yy += w * gy * gy;
      }
    const double gradient = 0.5 * std::atan2(2 * xy, xx - yy);  // of most change; the streaks run across it
    double angle = std::fabs(gradient) * 180 / std::numbers::pi;
    errors.push_back(std::fabs(90 - angle));
  }
  return errors;
}

}  // namespace nacre
