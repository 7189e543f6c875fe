// Nacre: what happens at points of the surface through the times of the data.
#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// A point of the surface, and what is there at each time. Of a surface that moves it is a point of the material.
struct FlowProbe {
  Vec3d asked, position;  ///< what was asked for; the nearest point of the surface, at the first time
  std::uint32_t triangle = 0;
  std::vector<double> times;
  std::vector<Vec3f> vectors;
  std::vector<float> speeds;   ///< along the surface
  std::vector<float> scalars;  ///< what colours; empty: nothing does
};

/// Points of the knob `probe`: "X,Y,Z", several with semicolons. Throws Error that names it.
std::vector<Vec3d> parse_probes(const std::string& text);

/// At the steps of the data; an analytic field is asked at 65 times. Throws Error where a point is farther from the
/// surface than a tenth of its diagonal, and where the triangles change; Interrupted where `stop` is set.
std::vector<FlowProbe> flow_probes(VectorsInTime& input, const std::string& points, const std::atomic<bool>* stop);

/// The report's key `probes`.
nlohmann::json probes_report(const std::vector<FlowProbe>& probes, const std::string& color);

}  // namespace nacre
