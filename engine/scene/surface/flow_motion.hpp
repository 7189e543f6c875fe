// Nacre: a flow on a surface that moves: when its shape is embedded again, and what is shown.
#pragma once

#include <functional>
#include <string>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Keeps the flow of a pipeline on the present shape of its data. The texture lives on the shape that is embedded,
/// whose triangles are the material, and is drawn where they are now; so nothing is resampled while it moves. The
/// present shape is embedded instead where it has become too different: where the triangles change, or where more than
/// a twentieth of its area is stretched or shortened by more than `most_stretch`. For still surfaces this is only
/// `embed` and `start`. All references must outlive it.
class FlowMotion {
 public:
  static constexpr double most_stretch = 1.5;
  static constexpr double stretched_share = 0.05;

  /// `wrap`: from the times of the flow to those of the data, where these come round; empty: they are the same.
  FlowMotion(FlowPipeline& pipeline, VectorsInTime& input, std::function<void(const std::string&)> warn,
             std::function<double(double)> wrap = {});

  /// Embeds the shape at a time of the data.
  void embed(double t);
  /// Starts the flow, embedding again if that must be at the flow's start; true if it was. Vectors as from
  /// `flow_vectors`; `between` as for FlowMethod.
  bool start(const FlowVectors& vectors, const std::function<void()>& between = {});
  /// Instead of `start`, after `embed` at the same time as then: goes on where another one was that had embedded again
  /// so often, at last the shape of time `base`; the rest as for FlowMethod.
  void go_on(const FlowVectors& vectors, double base, int rebuilds, int next, const TakeBytes& take,
             const std::function<void()>& between);
  /// Before each step: embeds the shape of the coming frame if that must be; true if it did.
  bool follow();
  /// After each step: pictures and values show the shape of the frame.
  void show();

  int rebuilds() const { return rebuilds_; }
  double base() const { return input_.base(); }  ///< of the data: when the embedded shape was the present one

 private:
  FlowMesh mesh() const;
  double data_time(double t) const { return wrap_ ? wrap_(t) : t; }
  bool is_stretched(double t);

  FlowPipeline& pipeline_;
  VectorsInTime& input_;
  std::function<void(const std::string&)> warn_;
  std::function<double(double)> wrap_;
  FlowVectors vectors_;
  double cell_size_ = 0, longest_ = 0;  ///< of the first shape
  int rebuilds_ = 0;
};

}  // namespace nacre
