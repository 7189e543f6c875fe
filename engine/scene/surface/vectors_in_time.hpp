// Nacre: the vectors of a series at any time, for the flow pipeline.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Interpolates linearly between the two steps around a time, which it keeps; also a scalar array to colour by.
class VectorsInTime {
 public:
  /// `vectors`: an array of the series or an analytic field; `color`: an array, "speed" or "none". Looks at every step
  /// once for the reference speed and the range of the colours. Throws Error where an array is missing in a step.
  /// Interrupted where `stop` is set.
  VectorsInTime(SurfaceSeries series, PreparedSurface surface, std::string vectors, std::string color,
                const std::atomic<bool>* stop = nullptr);

  // Other choices, without reading again what they do not concern. Where one throws, all is as it was.

  /// The same points with other triangles or normals.
  void set_surface(PreparedSurface surface);
  void set_vectors(const std::string& vectors);
  void set_color(const std::string& color);

  const SurfaceSeries& series() const { return series_; }
  const PreparedSurface& surface() const { return surface_; }
  const std::string& array() const { return vectors_; }  ///< the vectors' name
  const std::string& color() const { return color_; }
  double start() const { return start_; }
  double end() const { return end_; }

  /// Over all steps: the mean of the steps' 98th percentile, the largest speed, the smallest share of zeros; the share
  /// that is normal is the first step's.
  const VectorStatistics& statistics() const { return statistics_; }
  const ColourSpread& color_spread() const { return color_ == "speed" ? speeds_ : scalars_; }
  bool colored() const { return color_ != "none"; }

  /// One vector per point at time `t`.
  void vectors(double t, std::span<Vec3f> out);

  /// One number per point at time `t`: the array's (magnitude of vectors), or the tangential speed.
  std::vector<float> scalar(double t);

 private:
  struct Step {
    std::size_t number = ~std::size_t(0);
    std::vector<Vec3f> vectors;
    std::vector<float> scalar;
  };

  Step load(std::size_t number) const;
  const Step& step(std::size_t number);
  void survey(bool vectors_too = true);
  float speed_of(const Vec3f& vector, std::size_t point) const;
  void choose(const std::string& vectors, const std::string& color);
  /// The steps around `t` and the share of the later one.
  struct Between {
    std::size_t before, after;
    float share;
  };
  Between around(double t) const;

  SurfaceSeries series_;
  PreparedSurface surface_;
  std::vector<Vec3f> point_normals_;
  std::string vectors_, color_;
  bool analytic_;
  double start_, end_;
  ColourSpread speeds_, scalars_;  ///< of the vectors; of the array that colours
  VectorStatistics statistics_;
  Step steps_[2];
  std::size_t oldest_ = 0;
  const std::atomic<bool>* stop_;
};

}  // namespace nacre
