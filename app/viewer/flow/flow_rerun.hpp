// Nacre: what has to run again when knobs of the flow have changed.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// What the worker does, in this order.
enum class FlowStage {
  surface,  ///< cleaning, normals; at first also reading and choosing
  vectors,  ///< the choice of the vectors
  colours,  ///< the array to colour by
  arrows,   ///< their positions
  lines,    ///< topology and streamlines
  probes,   ///< what is at points through all times
  embed,    ///< from the triangles
  start,    ///< from the noise
  dyes,     ///< their sources
  step      ///< one more, which takes new values
};
inline constexpr int flow_stages = 10;

/// A set of stages.
class FlowRerun {
 public:
  FlowRerun() = default;
  FlowRerun(std::initializer_list<FlowStage> stages) {
    for (const FlowStage stage : stages) add(stage);
  }

  bool has(FlowStage stage) const { return has_[std::size_t(stage)]; }
  void add(FlowStage stage) { has_[std::size_t(stage)] = true; }
  void add(const FlowRerun& other);
  void remove(FlowStage stage) { has_[std::size_t(stage)] = false; }
  bool operator==(const FlowRerun&) const = default;

 private:
  std::array<bool, flow_stages> has_{};
};

/// Whether lines or tracks are drawn.
bool has_lines(const Settings& settings);

/// The stages that the changed knobs concern, and those that build on them.
FlowRerun flow_rerun(const Settings& before, const Settings& after);

}  // namespace nacre
