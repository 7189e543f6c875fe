// Nacre: what is known of a flow so far: for its panel and for what is probed. No OpenGL here.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/flow/flow_lines.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "engine/run/flow_probes.hpp"
#include "engine/run/shown_colours.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Vectors and colours are chosen.
struct FlowData {
  std::string array, color;  ///< what is shown, and what colours it
  std::string reason;        ///< why this array
  VectorStatistics statistics;
  Range time;                 ///< of the data
  ColourSpread colours;       ///< of what colours
  std::vector<double> times;  ///< of the steps of the data
  std::vector<float> scalar;  ///< at the time that is shown; empty: not coloured
  std::shared_ptr<const std::vector<Vec3f>> vectors;
  std::vector<std::string> warnings;
};

/// What could be shown and what could colour it: arrays on the points.
struct FlowOffer {
  std::vector<std::string> vectors, arrays;
};

struct FlowResults {
  std::shared_ptr<const TriangleTree> tree;  ///< null: nothing is read yet
  std::vector<Vec3d> corners;                ///< points that triangles use
  FlowOffer offer;
  FlowData data;
  FlowSpan span;
  ShownColours colours;                    ///< what the knobs make of them
  double time = 0;                         ///< that is shown, or will be first
  int steps = 0;                           ///< since the start
  std::shared_ptr<const FlowLines> lines;  ///< of that time; null: they are off
  std::vector<FlowProbe> probes;           ///< at points that are asked for
  std::vector<float> step_seconds;         ///< of the last ones
  std::optional<EmbeddingInfo> embedding;  ///< that is shown
};

/// A time of the data for people: 17280, 0.0333333.
inline std::string time_text(double time) { return fmt::format("{:.7g}", time); }

}  // namespace nacre
