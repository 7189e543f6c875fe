// Nacre: the flow map of a run.
#include "engine/run/flow_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "compute/transport/flow_map.hpp"
#include "engine/io/vtp_writer.hpp"
#include "engine/run/moments.hpp"
#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/welded.hpp"

namespace nacre {
namespace {

constexpr double most_crossings = 1000;  ///< of the surface, by a particle
constexpr int least_intervals = 64;      ///< in which a neighbour's leaving is noticed

double chosen_duration(const VectorsInTime& input, const FlowSpan& shown, double wanted, const Extent& extent) {
  if (input.moves() && input.series().motion->groups > 1)
    throw Error("a flow map needs the same triangles in all steps", "those of " + input.series().name + " change");
  const double speed = input.statistics().percentile_98;
  if (!(speed > 0) && !input.moves())
    throw Error("there is no flow map of " + input.array(), "it is zero everywhere", "choose others with `vectors`");
  const bool steady = !(input.end() > input.start());
  double duration = wanted;
  if (duration == 0) duration = steady ? extent.longest_side() / speed : shown.end - shown.first;
  const double from = duration > 0 ? shown.first : shown.end, to = from + duration;
  const double slack = 1e-9 * (input.end() - input.start());
  const bool endless = steady || input.motion().period > 0 || input.array().starts_with('@');
  if (!endless && (to < input.start() - slack || to > input.end() + slack))
    throw Error(
        fmt::format("`ftle_time` {:g} goes beyond the data", wanted),
        fmt::format("from {:g} to {:g}, and the data are those of {:g} to {:g}", from, to, input.start(), input.end()),
        fmt::format("use {:g} or less, or `period` if the data come round",
                    duration > 0 ? input.end() - from : input.start() - from));
  const double longest = most_crossings * extent.diagonal() / std::max(speed, 1e-300);
  if (!(std::fabs(duration) <= longest))
    throw Error(fmt::format("`ftle_time` {:g} is too long", duration),
                fmt::format("particles would go {:.3g} times across the surface",
                            std::fabs(duration) * speed / extent.diagonal()),
                fmt::format("use {:.3g} or less", longest));
  return duration;
}

/// Afterwards the shape is embedded again that was before.
class Rebased {
 public:
  explicit Rebased(VectorsInTime& input) : input_(input), base_(input.base()) {}
  ~Rebased() { input_.rebase(base_); }
  Rebased(const Rebased&) = delete;
  Rebased& operator=(const Rebased&) = delete;

 private:
  VectorsInTime& input_;
  double base_;
};

}  // namespace

SurfaceFlowMap surface_flow_map(VectorsInTime& input, const FlowSpan& shown, double duration,
                                const std::atomic<bool>* stop) {
  SurfaceFlowMap map;
  const Rebased shape(input);
  map.duration = chosen_duration(input, shown, duration, Extent(input.surface().points, input.surface().triangles));
  map.from = map.duration > 0 ? shown.first : shown.end;
  input.enter(map.from);
  input.rebase(map.from);
  map.points = input.surface().points;
  map.triangles = input.surface().triangles;
  const std::vector<Triangle> triangles = welded_triangles(input.surface());
  FlowOnSurface flow{map.points, triangles, moments(input, map.from, map.duration, least_intervals), {}};
  flow.vectors = [&](double t, std::span<Vec3f> out) { input.material_vectors(t, out); };
  if (input.moves()) flow.shape = [&](double t) { return input.points(t); };
  const FlowMap found = flow_map(flow, stop);
  map.left = found.left;
  map.ftle.assign(map.points.size(), std::numeric_limits<float>::quiet_NaN());
  map.time.assign(map.points.size(), 0);
  map.end = map.points;
  for (std::size_t c = 0; c < found.vertex.size(); ++c) {
    const std::uint32_t point = map.triangles[c / 3][int(c % 3)], v = found.vertex[c];
    map.ftle[point] = float(found.ftle[v]);
    map.time[point] = float(found.time[v]);
    map.end[point] = found.end[v];
  }
  return map;
}

nlohmann::json flow_map_report(const SurfaceFlowMap& map) {
  double low = 1e300, high = -1e300, sum = 0;
  std::size_t known = 0;
  for (const float each : map.ftle)
    if (std::isfinite(each)) {
      low = std::min(low, double(each));
      high = std::max(high, double(each));
      sum += each;
      ++known;
    }
  nlohmann::json report = {{"time", map.from},
                           {"duration", map.duration},
                           {"points", map.points.size()},
                           {"left", map.left},
                           {"unknown", map.points.size() - known}};
  if (known > 0) report["ftle"] = {{"min", low}, {"mean", sum / double(known)}, {"max", high}};
  return report;
}

void write_flow_map(const std::filesystem::path& file, const SurfaceFlowMap& map, const std::string& origin) {
  const std::vector<PointArray> arrays{{"FTLE", 1, map.ftle}, {"ftle_time", 1, map.time}};
  const PointPositions end{"flow_map", map.end};
  write_vtp(file, std::span<const Vec3d>(map.points), map.triangles, arrays, std::nullopt, {}, xml_origin(origin),
            std::span(&end, 1));
}

}  // namespace nacre
