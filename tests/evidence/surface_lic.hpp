// Nacre: line integral convolution (Cabral & Leedom 1993) on a surface's own cells, done with care and without haste:
// what a texture of these cells can show of the flow.
#pragma once

#include <tbb/parallel_for.h>

#include "compute/device/random.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "tests/evidence/point_bins.hpp"

namespace nacre {

/// White noise convolved along the velocities of `values`, which replace its texture.
class SurfaceLic {
 public:
  /// `cell`: edge of a texture cell, world units.
  SurfaceLic(const FlowValues& values, double cell)
      : values_(values), cell_(cell), bins_(values.closest_point, 2 * cell) {
    for (std::size_t i = 0; i < values.value.size(); ++i) {
      const Vec3d n = normalized(Vec3d(values.normal[i])), u(values.velocity[i]);
      direction_.push_back(normalized(u - n * dot(u, n)));
      noise_.push_back(uniform_random(11, std::uint32_t(i), 0));
    }
  }

  /// The mean of the noise on each cell's streamline, `reach` cells each way.
  std::vector<float> convolve(int reach) const {
    std::vector<float> result(values_.value.size());
    tbb::parallel_for(std::size_t(0), result.size(), [&](std::size_t i) {
      const Sample start = at(values_.closest_point[i]);
      double sum = start.noise;
      int count = 1;
      for (const double side : {1.0, -1.0}) {
        Vec3d p = values_.closest_point[i], along = start.direction;
        for (int k = 0; k < reach; ++k) {
          const Sample next = at(p + along * (side * cell_));
          if (!next.there || dot(next.direction, along) <= 0) break;
          p = next.point;
          along = next.direction;
          sum += next.noise;
          ++count;
        }
      }
      result[i] = float(sum / count);
    });
    return result;
  }

 private:
  struct Sample {
    Vec3d point, direction;  ///< put back onto the surface; a unit vector in it
    double noise = 0;
    bool there = false;
  };

  /// Interpolated among the five nearest cells.
  Sample at(const Vec3d& p) const {
    const auto near = bins_.nearest<5>(p, 4 * cell_);
    Sample sample;
    if (near[4].distance > 4 * cell_) return sample;
    Vec3d direction, normal, middle;
    double weight = 0;
    for (const PointBins::Neighbour& k : near) {
      const double r = k.distance / cell_ + 0.15, w = 1 / (r * r);
      direction += direction_[k.index] * w;
      normal += normalized(Vec3d(values_.normal[k.index])) * w;
      middle += values_.closest_point[k.index] * w;
      sample.noise += noise_[k.index] * w;
      weight += w;
    }
    normal = normalized(normal);
    direction = (direction - normal * dot(direction, normal)) / weight;
    sample.point = p - normal * dot(p - middle / weight, normal);
    sample.direction = normalized(direction);
    sample.noise /= weight;
    sample.there = near[0].distance < 1.5 * cell_ && length(direction) > 0.3;
    return sample;
  }

  const FlowValues& values_;
  double cell_;
  PointBins bins_;
  std::vector<Vec3d> direction_;
  std::vector<double> noise_;
};

}  // namespace nacre
