// Nacre: a surface with vectors over time, ready for the flow pipeline: the same for the command and the viewer.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "engine/scene/settings/settings.hpp"
#include "engine/scene/surface/surface.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Who is told what a user should know, in the order in which it is found; full sentences.
struct FlowNews {
  std::function<void(const std::string& sentence)> warn;
  std::function<void(const VectorChoice& choice)> chosen;  ///< which vectors, and why
  std::function<void(const Surface& first)> read = {};     ///< the first step, before a choice is made; may be empty
};

/// Prepares the surface of `series`, chooses vectors and looks at all steps. Throws Error where there is nothing to show,
/// Interrupted when `stop` is set.
VectorsInTime make_flow_input(SurfaceSeries series, const Settings& settings, const FlowNews& news,
                              const std::atomic<bool>* stop = nullptr);

/// Warns where the vectors show little: all zero, mostly normal to the surface, zero in many places.
void warn_of_vectors(const VectorsInTime& vectors, const FlowNews& news);

}  // namespace nacre
