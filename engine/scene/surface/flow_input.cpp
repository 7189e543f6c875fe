// Nacre: a surface with vectors over time, ready for the flow pipeline.
#include "engine/scene/surface/flow_input.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace nacre {

VectorsInTime make_flow_input(SurfaceSeries series, const Settings& settings, const FlowLog& log,
                              const std::atomic<bool>* stop) {
  for (const std::string& warning : series.warnings) log.warn(warning);
  const Surface first = series.load(0);
  if (log.read) log.read(first);
  std::vector<std::string> warnings;
  PreparedSurface surface = prepare(first, settings.crease_angle, &warnings);
  for (const std::string& warning : warnings) log.warn(warning);
  const VectorChoice choice = choose_vectors(first, settings.vectors);
  log.chosen(choice);
  if (log.first_step && series.steps() > 1) {
    SurfaceSeries alone;
    alone.name = series.name;
    alone.times = {series.times.front()};
    alone.load = [&first](std::size_t) { return first; };
    VectorsInTime seen(std::move(alone), surface, choice.name, settings.color, stop);
    log.first_step(seen);
  }
  VectorsInTime vectors(std::move(series), std::move(surface), choice.name, settings.color, stop);
  warn_of_vectors(vectors, log);
  return vectors;
}

void warn_of_vectors(const VectorsInTime& vectors, const FlowLog& log) {
  const VectorStatistics& s = vectors.statistics();
  if (s.percentile_98 <= 0)
    log.warn("the vectors are zero everywhere: the texture will remain noise");
  else if (s.normal_share > 0.5)
    log.warn(fmt::format("{} is {:.0f}% normal to the surface: only its tangential part is shown", vectors.array(),
                         100 * s.normal_share));
  if (s.zero_share > 0.5)
    log.warn(fmt::format("{} is zero at {:.0f}% of the points", vectors.array(), 100 * s.zero_share));
}

FlowVectors flow_vectors(VectorsInTime& input, double start, double end, const SurfacePart* part) {
  FlowVectors vectors;
  vectors.at = [&input](double t, std::span<Vec3f> out) { input.vectors(t, out); };
  if (part)
    vectors.at = [&input, part, whole = std::vector<Vec3f>(input.surface().points.size())](
                     double t, std::span<Vec3f> out) mutable {
      input.vectors(t, whole);
      part->take(whole, out);
    };
  vectors.start = start;
  vectors.end = end;
  const double speed = input.statistics().percentile_98;
  vectors.reference_speed = speed > 0 ? speed : 1;
  return vectors;
}

std::vector<Vec3d> triangle_corners(const PreparedSurface& surface) {
  std::vector<Vec3d> corners;
  corners.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) corners.push_back(surface.points[t[k]]);
  return corners;
}

}  // namespace nacre
